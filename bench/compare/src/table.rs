//! Printing tables.

/// How a table is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Style {
    /// Aligned columns.
    Plain,
    /// Markdown.
    Markdown,
}

/// A table: its head and its rows, all of one length.
pub(crate) struct Table {
    head: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows.
    pub(crate) fn new(head: &[&str]) -> Self {
        Self { head: head.iter().map(|&cell| cell.to_owned()).collect(), rows: Vec::new() }
    }

    /// Adds a row, of as many cells as the head has.
    pub(crate) fn push(&mut self, row: Vec<String>) {
        self.rows.push(row);
    }

    /// The table's text: the first column to the left, the others to the right.
    pub(crate) fn text(&self, style: Style) -> String {
        let all = || std::iter::once(&self.head).chain(&self.rows);
        let width = |column: usize| all().map(|row| row[column].chars().count()).max().unwrap_or_default();
        let widths: Vec<usize> = (0..self.head.len()).map(width).collect();
        let line = |row: &Vec<String>| {
            let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
                if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
            });
            let cells: Vec<String> = cells.collect();
            match style {
                Style::Plain => cells.join("  ") + "\n",
                Style::Markdown => format!("| {} |\n", cells.join(" | ")),
            }
        };
        let rule = match style {
            Style::Plain => "-".repeat(widths.iter().sum::<usize>() + 2 * (widths.len() - 1)) + "\n",
            Style::Markdown => {
                let cells = widths
                    .iter()
                    .enumerate()
                    .map(|(column, width)| if column == 0 { "-".repeat(*width) } else { "-".repeat(width - 1) + ":" });
                format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "))
            }
        };
        let rows: String = self.rows.iter().map(line).collect();
        line(&self.head) + &rule + &rows
    }
}
