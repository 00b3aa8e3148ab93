//! Formulas as Seamly2D and Valentina write them, those of the parser muParser.
//!
//! Method: tokens ([`lex`]), then a tree by precedence climbing, then its value. From the loosest:
//! `a ? b : c`, `||`, `&&`, comparisons, `+ -`, `* /`, the sign, `^`; `^` groups to the right, so
//! that `-2^2` is -4. Truth is 1 or 0, and what is not 0 is true. Arguments are divided by `;`.
//! Cost: linear. Limits: [`MOST_SIGNS`], [`DEEPEST`].

mod function;
mod lex;
#[cfg(test)]
mod tests;

use function::{Function, function};
use lex::{Token, TokenKind, tokens};

/// Characters of a formula.
pub const MOST_SIGNS: usize = 4_000;
/// Brackets, signs, powers and choices within each other.
pub const DEEPEST: usize = 60;

/// What is wrong with a formula, and at which of its characters, counted from 1.
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaFault {
    /// The character.
    pub at: usize,
    /// What is wrong there.
    pub what: String,
}

impl FormulaFault {
    fn new(at: usize, what: String) -> Self {
        FormulaFault { at, what }
    }
}

/// A formula that can be worked out.
#[derive(Debug, Clone)]
pub struct Formula(Expression);

#[derive(Debug, Clone)]
enum Expression {
    Number(f64),
    Name(String),
    Negative(Box<Expression>),
    /// Operands of operators of one precedence, from left to right.
    Chain(Box<Expression>, Vec<(FormulaOperator, Expression)>),
    Power(Box<Expression>, Box<Expression>),
    Choice(Box<[Expression; 3]>),
    Call(Function, Vec<Expression>),
}

#[derive(Debug, Clone, Copy)]
enum FormulaOperator {
    Or,
    And,
    Compare(fn(&f64, &f64) -> bool),
    Add,
    Subtract,
    Multiply,
    Divide,
}

impl Formula {
    /// Reads a formula.
    pub fn parse(text: &str) -> Result<Self, FormulaFault> {
        if text.len() > MOST_SIGNS {
            return Err(FormulaFault::new(1, format!("it is longer than {MOST_SIGNS} characters")));
        }
        let tokens = tokens(text)?;
        let end = text.chars().count() + 1;
        let mut parser = FormulaParser { tokens: &tokens, next: 0, end, depth: 0 };
        let root = parser.choice()?;
        match tokens.get(parser.next) {
            None => Ok(Formula(root)),
            Some(t) => Err(FormulaFault::new(t.at, "an operator is missing".to_owned())),
        }
    }

    /// Its value, with those of its variables.
    ///
    /// Errors: the first that `value` gives.
    pub fn value<E>(&self, mut value: impl FnMut(&str) -> Result<f64, E>) -> Result<f64, E> {
        worked_out(&self.0, &mut value)
    }
}

fn truth(is: bool) -> f64 {
    f64::from(u8::from(is))
}

fn worked_out<E>(e: &Expression, value: &mut dyn FnMut(&str) -> Result<f64, E>) -> Result<f64, E> {
    Ok(match e {
        Expression::Number(n) => *n,
        Expression::Name(name) => value(name)?,
        Expression::Negative(e) => -worked_out(e, value)?,
        Expression::Power(a, b) => worked_out(a, value)?.powf(worked_out(b, value)?),
        Expression::Choice(parts) => {
            let [condition, yes, no] = &**parts;
            let chosen = if worked_out(condition, value)? != 0.0 { yes } else { no };
            worked_out(chosen, value)?
        }
        Expression::Call(function, arguments) => {
            let all: Vec<f64> = arguments.iter().map(|a| worked_out(a, value)).collect::<Result<_, E>>()?;
            function.value(&all)
        }
        Expression::Chain(first, rest) => {
            let mut left = worked_out(first, value)?;
            for (operator, right) in rest {
                let right = worked_out(right, value)?;
                left = match operator {
                    FormulaOperator::Or => truth(left != 0.0 || right != 0.0),
                    FormulaOperator::And => truth(left != 0.0 && right != 0.0),
                    FormulaOperator::Compare(is) => truth(is(&left, &right)),
                    FormulaOperator::Add => left + right,
                    FormulaOperator::Subtract => left - right,
                    FormulaOperator::Multiply => left * right,
                    FormulaOperator::Divide => left / right,
                };
            }
            left
        }
    })
}

/// Operators of one precedence, the loosest first.
fn operator(level: usize, sign: &str) -> Option<FormulaOperator> {
    Some(match (level, sign) {
        (0, "||") => FormulaOperator::Or,
        (1, "&&") => FormulaOperator::And,
        (2, "<=") => FormulaOperator::Compare(f64::le),
        (2, ">=") => FormulaOperator::Compare(f64::ge),
        (2, "<") => FormulaOperator::Compare(f64::lt),
        (2, ">") => FormulaOperator::Compare(f64::gt),
        (2, "==") => FormulaOperator::Compare(f64::eq),
        (2, "!=") => FormulaOperator::Compare(f64::ne),
        (3, "+") => FormulaOperator::Add,
        (3, "-") => FormulaOperator::Subtract,
        (4, "*") => FormulaOperator::Multiply,
        (4, "/") => FormulaOperator::Divide,
        _ => return None,
    })
}

/// Levels of [`operator`].
const LEVELS: usize = 5;

struct FormulaParser<'t> {
    tokens: &'t [Token],
    next: usize,
    /// One behind the last character.
    end: usize,
    depth: usize,
}

impl FormulaParser<'_> {
    fn at(&self) -> usize {
        self.tokens.get(self.next).map_or(self.end, |t| t.at)
    }

    fn sign(&self) -> Option<&'static str> {
        match self.tokens.get(self.next)?.kind {
            TokenKind::Operator(op) => Some(op),
            _ => None,
        }
    }

    fn takes(&mut self, sign: &str) -> bool {
        let is = self.sign() == Some(sign);
        self.next += usize::from(is);
        is
    }

    fn fault(&self, what: &str) -> FormulaFault {
        FormulaFault::new(self.at(), what.to_owned())
    }

    /// Keeps the recursion within bounds.
    fn deeper<T>(
        &mut self,
        inner: impl FnOnce(&mut Self) -> Result<T, FormulaFault>,
    ) -> Result<T, FormulaFault> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(FormulaFault::new(
                self.at(),
                format!("more than {DEEPEST} brackets within each other"),
            ));
        }
        let out = inner(self);
        self.depth -= 1;
        out
    }

    fn choice(&mut self) -> Result<Expression, FormulaFault> {
        let condition = self.chain(0)?;
        if !self.takes("?") {
            return Ok(condition);
        }
        self.deeper(|p| {
            let yes = p.choice()?;
            if !p.takes(":") {
                return Err(p.fault("a \":\" is missing, as in \"a ? b : c\""));
            }
            Ok(Expression::Choice(Box::new([condition, yes, p.choice()?])))
        })
    }

    fn chain(&mut self, level: usize) -> Result<Expression, FormulaFault> {
        if level == LEVELS {
            return self.signed();
        }
        let first = self.chain(level + 1)?;
        let mut rest = Vec::new();
        while let Some(op) = self.sign().and_then(|s| operator(level, s)) {
            self.next += 1;
            rest.push((op, self.chain(level + 1)?));
        }
        Ok(if rest.is_empty() { first } else { Expression::Chain(Box::new(first), rest) })
    }

    fn signed(&mut self) -> Result<Expression, FormulaFault> {
        if self.takes("-") {
            return self.deeper(|p| Ok(Expression::Negative(Box::new(p.signed()?))));
        }
        if self.takes("+") {
            return self.deeper(Self::signed);
        }
        let base = self.operand()?;
        match self.takes("^") {
            true => self.deeper(|p| Ok(Expression::Power(Box::new(base), Box::new(p.signed()?)))),
            false => Ok(base),
        }
    }

    fn operand(&mut self) -> Result<Expression, FormulaFault> {
        let at = self.at();
        let Some(token) = self.tokens.get(self.next) else {
            return Err(self.fault("a number or a name is missing"));
        };
        match &token.kind {
            TokenKind::Number(n) => {
                self.next += 1;
                Ok(Expression::Number(*n))
            }
            TokenKind::Name(name) => {
                self.next += 1;
                self.named(name, at)
            }
            TokenKind::Operator("(") => {
                self.next += 1;
                let inner = self.deeper(Self::choice)?;
                match self.takes(")") {
                    true => Ok(inner),
                    false => Err(self.fault("a closing bracket is missing")),
                }
            }
            TokenKind::Operator(_) | TokenKind::Words => Err(self.fault("a number or a name is missing")),
        }
    }

    /// A variable, a constant or a call.
    fn named(&mut self, name: &str, at: usize) -> Result<Expression, FormulaFault> {
        if !self.takes("(") {
            return Ok(match name {
                "_pi" => Expression::Number(std::f64::consts::PI),
                "_e" => Expression::Number(std::f64::consts::E),
                _ => Expression::Name(name.to_owned()),
            });
        }
        let function = function(name)
            .ok_or_else(|| FormulaFault::new(at, format!("there is no function \"{name}\"")))?;
        let mut arguments = Vec::new();
        if !self.takes(")") {
            loop {
                arguments.push(self.argument(function, arguments.is_empty())?);
                if self.takes(")") {
                    break;
                }
                if !self.takes(";") && !self.takes(",") {
                    return Err(self.fault("a closing bracket is missing"));
                }
            }
        }
        match function.refuses(arguments.len()) {
            None => Ok(Expression::Call(function, arguments)),
            Some(takes) => Err(FormulaFault::new(at, format!("\"{name}\" {takes}, not {}", arguments.len()))),
        }
    }

    fn argument(&mut self, function: Function, first: bool) -> Result<Expression, FormulaFault> {
        let words = matches!(self.tokens.get(self.next), Some(Token { kind: TokenKind::Words, .. }));
        if first && words && matches!(function, Function::Warning) {
            self.next += 1;
            return Ok(Expression::Number(0.0));
        }
        self.deeper(Self::choice)
    }
}
