//! Text in a cell of a table with commas (RFC 4180) that a spreadsheet shows and does not calculate.
//!
//! A spreadsheet takes a cell that begins with one of a few signs for a formula, in quotes too, and a formula can ask other origins. Where free
//! text does so, an apostrophe stands before it, as is usual; numbers are never written by these functions.

/// Signs that begin a formula, in the full width of East Asian text too.
const SIGNS: [char; 8] = ['=', '+', '-', '@', '＝', '＋', '－', '＠'];

/// A cell of text, in quotes. What would break its line (control characters) becomes a space.
#[must_use]
pub fn quoted(text: &str) -> String {
    let text = one_line(text).replace('"', "\"\"");
    let apostrophe = if begins_formula(&text) { "'" } else { "" };
    format!("\"{apostrophe}{text}\"")
}

/// The text of a cell that [`quoted`] wrote, its quotes taken away already.
#[must_use]
pub fn plain(cell: &str) -> &str {
    cell.strip_prefix('\'')
        .filter(|text| begins_formula(text))
        .unwrap_or(cell)
}

/// Text within a line of a table's heading, which is no cell: where a comma, semicolon or tab in it would begin one for a spreadsheet, and that a
/// formula or a quote, an apostrophe stands between.
#[must_use]
pub fn in_heading(text: &str) -> String {
    let text = one_line(text);
    let mut out = String::with_capacity(text.len());
    let mut rest = text.as_str();
    while let Some(at) = rest.find([',', ';']) {
        let (before, after) = rest.split_at(at + 1);
        out.push_str(before);
        if begins_formula(after) || after.trim_start().starts_with('"') {
            out.push('\'');
        }
        rest = after;
    }
    out.push_str(rest);
    out
}

fn one_line(text: &str) -> String {
    text.replace(char::is_control, " ")
}

/// Some programs leave out white space before they look.
fn begins_formula(text: &str) -> bool {
    text.trim_start().starts_with(SIGNS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_cell_of_text_begins_a_formula_and_all_read_back() {
        for sign in SIGNS {
            for before in ["", " ", "  \u{a0}"] {
                let text = format!("{before}{sign}HYPERLINK(\"x\")");
                let cell = quoted(&text);
                assert!(cell.starts_with("\"'"), "{cell}");
                let read = cell[1..cell.len() - 1].replace("\"\"", "\"");
                assert_eq!(plain(&read), text);
            }
        }
        for text in [
            "0001.png",
            "it's 5-3=2",
            "'",
            "'quoted'",
            "",
            "\u{202e}gnp.1",
        ] {
            assert_eq!(quoted(text), format!("\"{text}\""));
            assert_eq!(plain(text), text);
        }
    }

    #[test]
    fn a_row_stays_one_row_and_a_sign_behind_control_characters_is_seen() {
        assert_eq!(quoted("\t=1\r\n+2"), "\"' =1  +2\"");
        assert_eq!(quoted("a\u{0}b\u{85}c"), "\"a b c\"");
    }

    #[test]
    fn a_heading_gives_a_spreadsheet_no_formula_in_its_further_cells() {
        assert_eq!(in_heading("knee, left; 2-3"), "knee, left; 2-3");
        assert_eq!(in_heading("a,=1;\t+2, \"@3\""), "a,'=1;' +2,' \"@3\"");
        let hostile = in_heading("x,=1,-2;@3,\"=4\"\n=5");
        let cells = hostile.split([',', ';', '\n']).skip(1);
        assert!(cells.clone().count() == 4 && cells.into_iter().all(|cell| cell.starts_with('\'')));
        // Read and written again it stays as it is.
        assert_eq!(in_heading(&hostile), hostile);
    }
}
