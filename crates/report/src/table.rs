//! A table of text with aligned columns.
use super::{
    line_width::count_columns,
    style::{Style, TextStyle},
};

/// A cell of a table, with its text and its style.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cell {
    text: String,
    style: Option<TextStyle>,
}

impl Cell {
    /// Creates a cell whose text has a style.
    pub fn with_style(look: TextStyle, text: impl Into<String>) -> Self {
        Self { text: text.into(), style: Some(look) }
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Self {
        Self { text: text.into(), style: None }
    }
}

/// The alignment of a column's text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// The text begins at the left edge. This suits words.
    Left,
    /// The text ends at the right edge. This suits numbers.
    Right,
}

/// A table with a fixed number of columns.
#[derive(Debug, Clone)]
pub struct Table<const COLUMNS: usize> {
    columns: [Align; COLUMNS],
    rows: Vec<[Cell; COLUMNS]>,
}

impl<const COLUMNS: usize> Table<COLUMNS> {
    /// Creates a table without rows. `columns` has the alignment of each column.
    pub const fn new(columns: [Align; COLUMNS]) -> Self {
        Self { columns, rows: Vec::new() }
    }

    /// Appends a row with one cell per column.
    pub fn add_row(&mut self, cells: [Cell; COLUMNS]) {
        self.rows.push(cells);
    }

    /// Appends a row whose cells are headings.
    pub fn add_heading(&mut self, titles: [&str; COLUMNS]) {
        self.add_row(titles.map(|title| Cell::with_style(TextStyle::Faint, title)));
    }

    /// Renders each row as a line, indented by two blanks. There are three blanks between columns, and none at the ends
    /// of lines.
    pub fn render(&self, style: Style) -> String {
        let width =
            |column: usize| self.rows.iter().map(|row| count_columns(&row[column].text)).max().unwrap_or_default();
        let widths: [usize; COLUMNS] = std::array::from_fn(width);
        let mut text = String::new();
        for row in &self.rows {
            let mut line = String::from(" ");
            let mut gap = 1;
            for ((cell, align), width) in row.iter().zip(self.columns).zip(widths) {
                let blanks = width - count_columns(&cell.text);
                let (before, after) = if align == Align::Right { (blanks, 0) } else { (0, blanks) };
                if !cell.text.is_empty() {
                    line += &" ".repeat(gap + before);
                    line += &cell.style.map_or_else(|| cell.text.clone(), |look| style.paint(look, &cell.text));
                    gap = after + 3;
                } else {
                    gap += width + 3;
                }
            }
            text += &line;
            text += "\n";
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up_and_lines_have_no_trailing_blanks() {
        let mut table = Table::new([Align::Left, Align::Right, Align::Left]);
        table.add_heading(["name", "n", "note"]);
        table.add_row(["a".into(), "100".into(), "".into()]);
        table.add_row(["longer".into(), "".into(), Cell::with_style(TextStyle::Wrong, "no")]);
        assert_eq!(table.render(Style::Plain), "  name       n   note\n  a        100\n  longer         no\n");
    }

    #[test]
    fn colors_do_not_move_columns() {
        let mut table = Table::new([Align::Right, Align::Left]);
        table.add_row([Cell::with_style(TextStyle::Right, "1"), "x".into()]);
        table.add_row(["10".into(), "y".into()]);
        assert_eq!(table.render(Style::Color), "   \x1b[1;32m1\x1b[0m   x\n  10   y\n");
    }
}
