#![allow(clippy::unwrap_used)]
use super::*;
use proptest::prelude::*;

fn value(text: &str) -> f64 {
    let known = |name: &str| match name {
        "waist_circ" => Ok(72.0),
        "#ease" => Ok(4.0),
        "@arm" => Ok(2.5),
        "Line_А_Г" => Ok(10.0),
        other => Err(other.to_owned()),
    };
    Formula::parse(text).unwrap().value(known).unwrap()
}

#[test]
fn operators_bind_as_in_muparser() {
    let cases = [
        ("1+2*3", 7.0),
        ("(1+2)*3", 9.0),
        ("-2^2", -4.0),
        ("2^-1", 0.5),
        ("2^3^2", 512.0),
        ("10-4-3", 3.0),
        ("12/3/2", 2.0),
        ("- 2 * -3", 6.0),
        ("1 < 2 && 2 < 1 || 3 >= 3", 1.0),
        ("1 == 1 ? 5 : 6", 5.0),
        ("0 ? 1 : 0 ? 2 : 3", 3.0),
        ("1.5e1 + .5", 15.5),
        ("waist_circ/4 + #ease - @arm", 19.5),
        ("0.5*Line_А_Г", 5.0),
        ("2*_pi", std::f64::consts::TAU),
    ];
    for (text, expected) in cases {
        assert!((value(text) - expected).abs() < 1e-12, "{text}: {}", value(text));
    }
}

#[test]
fn functions_take_radians_or_degrees() {
    let cases = [
        ("sinD(30)", 0.5),
        ("cos(0)", 1.0),
        ("atanD(1)", 45.0),
        ("acosD(0.5)", 60.0),
        ("degTorad(180)", std::f64::consts::PI),
        ("min(3;1;2) + max(3;1;2)", 4.0),
        ("sqrt(9)", 3.0),
        ("abs(-2)", 2.0),
        ("rint(2.5)", 3.0),
        ("rint(-2.5)", -2.0),
        ("fmod(7;4)", 3.0),
        ("avg(1;2;6)", 3.0),
        ("sign(-8)", -1.0),
        ("r2cm(1.26)", 1.3),
        ("log(100) + ln(1) + log2(8)", 5.0),
        ("warning(\"too (wide\"; 7)", 7.0),
    ];
    for (text, expected) in cases {
        assert!((value(text) - expected).abs() < 1e-12, "{text}: {}", value(text));
    }
}

#[test]
fn a_variable_of_the_branch_that_is_not_taken_may_be_unknown() {
    assert_eq!(value("1 ? 2 : unknown"), 2.0);
}

#[test]
fn faults_name_their_character() {
    let cases = [
        ("", 1, "a number or a name is missing"),
        ("waist_circ/(4", 14, "a closing bracket is missing"),
        ("2 3", 3, "an operator is missing"),
        ("4+*2", 3, "a number or a name is missing"),
        ("half(2)", 1, "there is no function \"half\""),
        ("sin(1;2)", 1, "\"sin\" takes one argument, not 2"),
        ("max()", 1, "\"max\" takes at least one argument, not 0"),
        ("1 ? 2", 6, "a \":\" is missing, as in \"a ? b : c\""),
        ("2 % 3", 3, "\"%\" is no sign of a formula"),
        ("#a = 2; #a", 4, "a formula that sets variables is not read"),
        ("1..2", 3, "an operator is missing"),
        (".", 1, "\".\" is no number"),
    ];
    for (text, at, what) in cases {
        let fault = Formula::parse(text).unwrap_err();
        assert_eq!((fault.at, fault.what.as_str()), (at, what), "{text}");
    }
    let deep = "(".repeat(100);
    assert_eq!(Formula::parse(&deep).unwrap_err().what, "more than 60 brackets within each other");
    let long = "1+".repeat(3_000);
    assert_eq!(Formula::parse(&long).unwrap_err().what, "it is longer than 4000 characters");
}

/// A formula with the value that it has by the reference.
#[derive(Debug, Clone)]
struct Case {
    text: String,
    value: f64,
}

fn case() -> impl Strategy<Value = Case> {
    let number = (0u32..2000).prop_map(|n| {
        let value = f64::from(n) / 8.0;
        Case { text: format!("{value}"), value }
    });
    number.prop_recursive(5, 60, 3, |inner| {
        let two = (inner.clone(), inner.clone(), 0usize..8).prop_map(|(a, b, k)| joined(&a, &b, k));
        let one = (inner.clone(), 0usize..5).prop_map(|(a, k)| applied(&a, k));
        let choice = (inner.clone(), inner.clone(), inner).prop_map(|(a, b, c)| Case {
            text: format!("(({}) ? ({}) : ({}))", a.text, b.text, c.text),
            value: if a.value != 0.0 { b.value } else { c.value },
        });
        prop_oneof![two, one, choice]
    })
}

fn joined(a: &Case, b: &Case, k: usize) -> Case {
    let (x, y) = (a.value, b.value);
    let truth = |is: bool| if is { 1.0 } else { 0.0 };
    let (op, value) = [
        ("+", x + y),
        ("-", x - y),
        ("*", x * y),
        ("/", x / y),
        ("<", truth(x < y)),
        (">=", truth(x >= y)),
        ("&&", truth(x != 0.0 && y != 0.0)),
        ("||", truth(x != 0.0 || y != 0.0)),
    ][k];
    Case { text: format!("({} {op} {})", a.text, b.text), value }
}

fn applied(a: &Case, k: usize) -> Case {
    let x = a.value;
    let (name, value) = [
        ("abs", x.abs()),
        ("sinD", (x * std::f64::consts::PI / 180.0).sin()),
        ("-", -x),
        ("sqrt", x.sqrt()),
        ("rint", (x + 0.5).floor()),
    ][k];
    Case { text: format!("{name}({})", a.text), value }
}

proptest! {
    #[test]
    fn formulas_have_the_value_of_the_reference(case in case()) {
        let unknown = |name: &str| Err(name.to_owned());
        let found = Formula::parse(&case.text).unwrap().value(unknown).unwrap();
        let same = found == case.value || (found.is_nan() && case.value.is_nan())
            || (found - case.value).abs() <= 1e-9 * case.value.abs();
        prop_assert!(same, "{} is {found}, not {}", case.text, case.value);
    }

    #[test]
    fn no_text_panics(text in "[-+*/^()?:;,<>=!&|0-9a-zA-Z#@_. \"é]{0,60}") {
        if let Ok(formula) = Formula::parse(&text) {
            let _ = formula.value(|_| Ok::<f64, ()>(1.5));
        }
    }
}
