// In a shell `#` begins a comment only at the start of a word: `find_objects#red` is a name. The highlighter of the book
// takes it for a comment, so blocks of commands are coloured here, after it.
for (const code of document.querySelectorAll("code.language-sh")) {
    const lines = code.textContent.split("\n").map((line) => {
        const at = line.search(/(^|\s)#/);
        const [command, comment] = at < 0 ? [line, ""] : [line.slice(0, at), line.slice(at)];
        const parts = [document.createTextNode(command)];
        if (comment) {
            const span = document.createElement("span");
            span.className = "hljs-comment";
            span.textContent = comment;
            parts.push(span);
        }
        return parts;
    });
    code.replaceChildren(...lines.flatMap((parts, index) => (index ? [document.createTextNode("\n"), ...parts] : parts)));
}

// A name such as `--plot` stays whole where lines break, unless it is long.
for (const code of document.querySelectorAll("main :not(pre) > code")) {
    if (code.textContent.length <= 28) {
        code.classList.add("whole");
    }
}

// Long values in tables, such as JSON without blanks, may be broken behind their marks, lest they push other columns out.
for (const cell of document.querySelectorAll("main td")) {
    const walker = document.createTreeWalker(cell, NodeFilter.SHOW_TEXT);
    const texts = [];
    while (walker.nextNode()) {
        texts.push(walker.currentNode);
    }
    for (const text of texts.filter((node) => /\S{25}/.test(node.data))) {
        const code = text.parentElement.closest("code");
        if (code && cell.cellIndex === 0) {
            continue;
        }
        code?.classList.remove("whole");
        const parts = text.data.split(/(?<=[,;/#_])/);
        text.replaceWith(...parts.flatMap((part, index) => (index ? [document.createElement("wbr"), part] : [part])));
    }
}
