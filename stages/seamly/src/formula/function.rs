//! The functions of formulas. Angles are in radians, but for those whose name ends in `D`.

/// A function of numbers.
#[derive(Debug, Clone, Copy)]
pub(super) enum Function {
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
    /// Any number of arguments, at least one.
    Many(fn(&[f64]) -> f64),
    /// Words, then a number, which is its value.
    Warning,
}

/// The function of that name.
pub(super) fn function(name: &str) -> Option<Function> {
    use Function::{Many, One, Two};
    Some(match name {
        "sin" => One(f64::sin),
        "cos" => One(f64::cos),
        "tan" => One(f64::tan),
        "asin" => One(f64::asin),
        "acos" => One(f64::acos),
        "atan" => One(f64::atan),
        "sinD" => One(|v| v.to_radians().sin()),
        "cosD" => One(|v| v.to_radians().cos()),
        "tanD" => One(|v| v.to_radians().tan()),
        "asinD" => One(|v| v.asin().to_degrees()),
        "acosD" => One(|v| v.acos().to_degrees()),
        "atanD" => One(|v| v.atan().to_degrees()),
        "sinh" => One(f64::sinh),
        "cosh" => One(f64::cosh),
        "tanh" => One(f64::tanh),
        "asinh" => One(f64::asinh),
        "acosh" => One(f64::acosh),
        "atanh" => One(f64::atanh),
        "degTorad" => One(f64::to_radians),
        "radTodeg" => One(f64::to_degrees),
        "log2" => One(f64::log2),
        "log10" | "log" => One(f64::log10),
        "ln" => One(f64::ln),
        "exp" => One(f64::exp),
        "sqrt" => One(f64::sqrt),
        "sign" => One(|v| if v == 0.0 { 0.0 } else { v.signum() }),
        "rint" => One(|v| (v + 0.5).floor()),
        "r2cm" => One(|v| (v * 10.0 + 0.5).floor() / 10.0),
        "abs" => One(f64::abs),
        "atan2" => Two(f64::atan2),
        "fmod" => Two(|a, b| a % b),
        "sum" => Many(|all| all.iter().sum()),
        "avg" => Many(|all| all.iter().sum::<f64>() / all.len() as f64),
        "min" => Many(|all| all.iter().copied().fold(f64::INFINITY, f64::min)),
        "max" => Many(|all| all.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
        "warning" => Function::Warning,
        _ => return None,
    })
}

impl Function {
    /// What is wrong with that many arguments.
    pub(super) fn refuses(self, count: usize) -> Option<&'static str> {
        match self {
            Function::One(_) if count != 1 => Some("takes one argument"),
            Function::Two(_) | Function::Warning if count != 2 => Some("takes two arguments"),
            Function::Many(_) if count == 0 => Some("takes at least one argument"),
            _ => None,
        }
    }

    /// Its value; the arguments are as many as it takes.
    pub(super) fn value(self, arguments: &[f64]) -> f64 {
        match (self, arguments) {
            (Function::One(f), [a, ..]) => f(*a),
            (Function::Two(f), [a, b, ..]) => f(*a, *b),
            (Function::Many(f), all) => f(all),
            (Function::Warning, [.., last]) => *last,
            _ => f64::NAN,
        }
    }
}
