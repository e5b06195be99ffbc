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
