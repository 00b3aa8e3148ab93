//! The tokens of a formula.

use super::FormulaFault;

/// A token with the character that it begins at, counted from 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    pub(super) at: usize,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum TokenKind {
    Number(f64),
    /// A variable or a function.
    Name(String),
    /// The text in quotation marks that `warning` has.
    Words,
    Operator(&'static str),
}

/// Operators and signs, the longer before those that they begin with.
const OPERATORS: [&str; 21] = [
    "&&", "||", "<=", ">=", "==", "!=", "<", ">", "+", "-", "*", "/", "^", "?", ":", "(", ")", ";", ",", "&",
    "|",
];

/// The tokens of a formula.
///
/// Errors: a sign that no formula has, a number that cannot be read, words without an end.
pub(super) fn tokens(text: &str) -> Result<Vec<Token>, FormulaFault> {
    let chars: Vec<char> = text.chars().collect();
    let (mut out, mut k) = (Vec::new(), 0);
    while k < chars.len() {
        let (kind, length) = match chars[k] {
            c if c.is_whitespace() => {
                k += 1;
                continue;
            }
            c if c.is_ascii_digit() || c == '.' => number(&chars[k..], k + 1)?,
            '"' => words(&chars[k..], k + 1)?,
            c => match operator(&chars[k..]) {
                Some(op) => (TokenKind::Operator(op), op.len()),
                None if is_of_name(c) => name(&chars[k..]),
                None if c == '=' => {
                    return Err(FormulaFault::new(
                        k + 1,
                        "a formula that sets variables is not read".to_owned(),
                    ));
                }
                None => return Err(FormulaFault::new(k + 1, format!("\"{c}\" is no sign of a formula"))),
            },
        };
        out.push(Token { kind, at: k + 1 });
        k += length;
    }
    Ok(out)
}

fn operator(rest: &[char]) -> Option<&'static str> {
    OPERATORS.into_iter().find(|op| op.chars().enumerate().all(|(i, c)| rest.get(i) == Some(&c)))
}

/// Names have letters of any script, digits, `#`, `@` and `_`.
fn is_of_name(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '#' | '@' | '$' | '~' | '{' | '}' | '[' | ']' | '°' | '№')
}

fn name(rest: &[char]) -> (TokenKind, usize) {
    let name: String = rest.iter().take_while(|c| is_of_name(**c) || is_mark(**c)).collect();
    let length = name.chars().count();
    (TokenKind::Name(name), length)
}

/// Accents that stand behind their letter.
fn is_mark(c: char) -> bool {
    matches!(c, '\u{300}'..='\u{36f}' | '\u{5b0}'..='\u{5c7}' | '\u{64b}'..='\u{65f}' | '\u{900}'..='\u{dff}')
}

/// A number such as `12`, `0.5`, `.5` or `1e-3`.
fn number(rest: &[char], at: usize) -> Result<(TokenKind, usize), FormulaFault> {
    let digits = |from: usize| rest[from..].iter().take_while(|c| c.is_ascii_digit()).count();
    let mut length = digits(0);
    if rest.get(length) == Some(&'.') {
        length += 1 + digits(length + 1);
    }
    if matches!(rest.get(length), Some('e' | 'E')) {
        let sign = usize::from(matches!(rest.get(length + 1), Some('+' | '-')));
        let from = length + 1 + sign;
        let exponent = if from < rest.len() { digits(from) } else { 0 };
        if exponent > 0 {
            length = from + exponent;
        }
    }
    let text: String = rest[..length].iter().collect();
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok((TokenKind::Number(value), length)),
        _ => Err(FormulaFault::new(at, format!("\"{text}\" is no number"))),
    }
}

fn words(rest: &[char], at: usize) -> Result<(TokenKind, usize), FormulaFault> {
    match rest[1..].iter().position(|c| *c == '"') {
        Some(end) => Ok((TokenKind::Words, end + 2)),
        None => Err(FormulaFault::new(at, "the quotation mark has no end".to_owned())),
    }
}
