//! Tables as CSV (RFC 4180): commas between cells, quotes around cells that hold some.

/// The line of a table, from 1, and what stands there.
type AtLine<T> = (usize, T);

/// The rows of a table; rows without any text are left out.
///
/// Errors: a sentence.
pub(crate) fn rows(text: &str) -> Result<Vec<AtLine<Vec<String>>>, AtLine<String>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut rows = Vec::new();
    let mut row = Vec::new();
    let mut chars = text.chars().peekable();
    let (mut line, mut first) = (1, 1);
    while chars.peek().is_some() {
        let mut cell = String::new();
        if chars.peek() == Some(&'"') {
            chars.next();
            let opened = line;
            loop {
                match chars.next() {
                    Some('"') if chars.peek() == Some(&'"') => cell.extend(chars.next()),
                    Some('"') => break,
                    Some(c) => {
                        line += usize::from(c == '\n');
                        cell.push(c);
                    }
                    None => return Err((opened, "a quote is opened and not closed".into())),
                }
            }
        } else {
            while let Some(c) = chars.next_if(|c| ![',', '\n'].contains(c)) {
                cell.push(c);
            }
        }
        row.push(cell.trim().to_owned());
        chars.next_if_eq(&'\r');
        match chars.next() {
            Some(',') if chars.peek().is_some() => continue,
            Some(',') => row.push(String::new()),
            Some('\n') | None => {}
            Some(c) => return Err((line, format!("`{c}` stands behind a closing quote"))),
        }
        let ended = std::mem::take(&mut row);
        if ended.iter().any(|cell| !cell.is_empty()) {
            rows.push((first, ended));
        }
        line += 1;
        first = line;
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn cells_stand_between_commas_and_quotes_hold_some() {
        let text = "id,body.height\r\na,1.8 m\n\nb,\"x, \"\"y\"\"\nz\"\nc,\n";
        let row = |line, cells: [&str; 2]| (line, cells.map(str::to_owned).to_vec());
        let rows = rows(text).unwrap();
        let wanted = [
            row(1, ["id", "body.height"]),
            row(2, ["a", "1.8 m"]),
            row(4, ["b", "x, \"y\"\nz"]),
            row(6, ["c", ""]),
        ];
        assert_eq!(rows, wanted);
    }

    #[test]
    fn a_quote_that_stays_open_is_told_by_line() {
        assert_eq!(rows("a\n\"b\nc"), Err((2, "a quote is opened and not closed".into())));
        assert_eq!(rows("a\n\"b\"c"), Err((2, "`c` stands behind a closing quote".into())));
    }
}
