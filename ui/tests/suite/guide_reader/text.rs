//! The guide, as a test reads it: what it says is to be typed is typed from it.

/// The text of the guide.
const TEXT: &str = include_str!("../../../../docs/GUIDE.md");

/// A section of the guide.
#[derive(Clone, Copy)]
pub struct Section(&'static str);

/// The section with a heading.
pub fn section(heading: &str) -> Section {
    let parts = TEXT.split("\n## ");
    let mut parts = parts.filter(|part| part.lines().next() == Some(heading));
    Section(
        parts
            .next()
            .unwrap_or_else(|| panic!("no {heading:?} in the guide")),
    )
}

impl Section {
    /// The rows under the number of the table, of those whose head begins so: what stands in
    /// backticks in each, or the cell as it is where nothing does.
    pub fn table(self, head: &str, number: usize) -> Vec<Vec<&'static str>> {
        let start = format!("| {head} |");
        let mut lines = self.0.lines();
        for _ in 0..=number {
            let found = lines.by_ref().any(|line| line.starts_with(&start));
            assert!(found, "no table {start:?}, {number}");
        }
        let rows = lines.skip(1).take_while(|line| line.starts_with('|'));
        let cell = |cell: &'static str| {
            let inside = cell.split('`').nth(1);
            inside.unwrap_or(cell.trim())
        };
        rows.map(|row| {
            let inner = row.trim_matches('|');
            inner.split(" | ").map(cell).collect()
        })
        .collect()
    }

    /// The lines of its block of code.
    pub fn block(self) -> Vec<&'static str> {
        let inside = self.0.split("```").nth(1);
        inside.unwrap().trim().lines().collect()
    }

    /// What is typed, which stands in the section in backticks.
    pub fn says(self, typed: &str) -> &str {
        let stands = self.0.contains(&format!("`{typed}`"));
        assert!(stands, "the guide does not say `{typed}`");
        typed
    }
}

/// Names the guide prints bold: those of commands, menus, fields and buttons. The beginning of a
/// paragraph, which ends with a full stop, is none.
pub fn bold() -> Vec<&'static str> {
    let all = TEXT.split("**").skip(1).step_by(2);
    all.filter(|name| !name.ends_with('.')).collect()
}

/// Pictures the guide shows.
pub fn pictures() -> Vec<&'static str> {
    let parts = TEXT.split("](screens/").skip(1);
    parts.filter_map(|part| part.split(".png").next()).collect()
}
