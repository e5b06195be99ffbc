//! Parses the fenced blocks of a page into language, marks and text.

/// The contents of a fenced block.
#[derive(Debug, PartialEq)]
pub(crate) struct Block {
    /// The first word after the fence.
    pub(crate) language: String,
    /// The remaining words, such as `output` or `file=my_task.json`.
    pub(crate) marks: Vec<String>,
    /// The contents, with a line break after each line.
    pub(crate) text: String,
    /// The line of the opening fence, from 1.
    pub(crate) line: usize,
}

impl Block {
    pub(crate) fn has(&self, mark: &str) -> bool {
        self.marks.iter().any(|found| found == mark)
    }

    /// The file name under which the page tells its reader to save it.
    pub(crate) fn file(&self) -> Option<&str> {
        self.marks.iter().find_map(|mark| mark.strip_prefix("file="))
    }
}

/// Every block of a page, in order. A comment `<!-- prepare` is a block too: it holds commands that create files which the page
/// assumes, such as the reader's own logs.
pub(crate) fn blocks(page: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut open: Option<Block> = None;
    for (index, line) in page.lines().enumerate() {
        let fence = match line {
            "<!-- prepare" => Some("sh prepare"),
            "-->" if open.as_ref().is_some_and(|block| block.has("prepare")) => Some(""),
            line => line.strip_prefix("```"),
        };
        match (&mut open, fence) {
            (None, Some(words)) => {
                let mut words = words.split_whitespace().map(str::to_owned);
                open = Some(Block {
                    language: words.next().unwrap_or_default(),
                    marks: words.collect(),
                    text: String::new(),
                    line: index + 1,
                });
            }
            (Some(_), Some("")) => blocks.extend(open.take()),
            (Some(block), _) => {
                block.text.push_str(line);
                block.text.push('\n');
            }
            (None, None) => {}
        }
    }
    assert!(open.is_none(), "a block is not closed: {open:?}");
    blocks
}

#[test]
fn blocks_have_language_marks_and_text() {
    let found = blocks("a\n```json file=a.json\n{\n}\n```\n\n```text output\n```\n");
    let block = |language: &str, mark: &str, text: &str, line| Block {
        language: language.to_owned(),
        marks: vec![mark.to_owned()],
        text: text.to_owned(),
        line,
    };
    assert_eq!(
        found,
        [
            block("json", "file=a.json", "{\n}\n", 2),
            block("text", "output", "", 7)
        ]
    );
    assert_eq!(found[0].file(), Some("a.json"));
    assert!(found[1].has("output") && !found[1].has("file"));
    assert_eq!(
        blocks("<!-- prepare\na\n-->\n<!-- b\n-->\n"),
        [block("sh", "prepare", "a\n", 1)]
    );
}
