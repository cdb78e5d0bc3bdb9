//! Results of the reading of formulas, and messages about those that are none.

use super::*;
use model::Vec3;

const LENGTH: Powers = [1, 0, 0, 0, 0];
const VELOCITY: Powers = [1, 0, -1, 0, 0];
const KELVIN: Powers = [0, 0, 0, 1, 0];

/// The value of a formula at x = 2 mm, y = 3 mm, z = 7 mm of a body about (2, 3, 3) mm.
fn value(text: &str, powers: Powers) -> f64 {
    let (profile, found) = read(text, 3).unwrap_or_else(|e| panic!("{text}: {}", e.title));
    assert_eq!(found, powers, "{text}");
    let at = |x: [f64; 3]| Vec3::from(x.map(|x| 1e-3 * x));
    profile.at(&Place::new(&at([2.0, 3.0, 7.0]), &at([2.0, 3.0, 3.0])))
}

#[test]
fn operators_bind_as_on_paper() {
    for (text, expected) in [
        ("-2^2", -4.0),
        ("(-2)^2", 4.0),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("--2", 2.0),
        ("3 - -2", 5.0),
        ("8/4/2", 1.0),
        ("8 - 4 - 2", 2.0),
        ("2 + 3 * 4", 14.0),
        ("(2 + 3) * 4", 20.0),
        ("3² + 2³", 17.0),
        ("6·7", 42.0),
        ("min(1, max(2, 3)) + 10", 11.0),
        ("min(max(1, 2), 3)", 2.0),
        ("sqrt(16) + abs(-3) + step(-1) + step(0)", 8.0),
        ("hypot(3, 4) * exp(0) + ln(1) + log10(100)", 7.0),
        ("cos(180 deg) + sin(0) + tanh(0)", -1.0),
        ("atan2(1, 1) / pi", 0.25),
        ("1e3 + .5", 1000.5),
    ] {
        let found = value(text, PLAIN);
        assert!(
            (found - expected).abs() < 1e-15 * expected.abs(),
            "{text}: {found}"
        );
        // The same where nothing is known before the place is.
        let varied = text.replacen('2', "(2 * x / x)", 1);
        if varied != text && !text.contains("20") && !text.contains("atan2") {
            let found = value(&varied, PLAIN);
            assert!(
                (found - expected).abs() < 1e-15 * expected.abs(),
                "{varied}: {found}"
            );
        }
    }
}

#[test]
fn quantities_keep_their_dimensions() {
    for (text, expected, powers) in [
        ("-3 km/s * (1 - (r / 8 mm)^2)", -2250.0, VELOCITY),
        ("x / 1 us", 2e3, VELOCITY),
        ("100 rad/s * y", 0.3, VELOCITY),
        ("z - z0", 4e-3, LENGTH),
        ("r", 4e-3, LENGTH),
        ("sqrt(x^2 + y^2 + 3 mm²)", 4e-3, LENGTH),
        ("300 K + 5 K/mm * z", 335.0, KELVIN),
        ("20 °C + 5 °C/mm * z", 328.15, KELVIN),
        ("20 °C + 10 K * step(z - 5 mm)", 303.15, KELVIN),
        ("30 °C - 20 °C", 10.0, KELVIN),
        ("-20 °C", 253.15, KELVIN),
        ("max(0 °C, 250 K)", 273.15, KELVIN),
        ("max(0, 1 m/s - 1 m/s * x / 1 mm)", 0.0, VELOCITY),
        ("7 km/s", 7e3, VELOCITY),
        ("-7 km/s", -7e3, VELOCITY),
        ("0", 0.0, PLAIN),
        ("0 * x / x", 0.0, PLAIN),
        ("0 + x", 2e-3, LENGTH),
        ("2 m / (1 s)", 2.0, VELOCITY),
        ("1 m/s * exp(-(r / 4 mm)^2)", libm::exp(-1.0), VELOCITY),
    ] {
        let found = value(text, powers);
        assert!(
            (found - expected).abs() <= 1e-14 * expected.abs(),
            "{text}: {found}"
        );
    }
    let constant = |text| read(text, 3).unwrap().0.constant();
    assert_eq!(constant("-1 km/s"), Some(-1e3));
    assert_eq!(constant("2 * (3 + 4)"), Some(14.0));
    assert_eq!(constant("0 * x"), None);
}

/// Refuses texts at a place in them, or anywhere if that is nothing, with a title.
fn refuse(texts: &[(&str, &str, &str)]) {
    for (text, place, title) in texts {
        let diagnostic = read(text, 3).expect_err(text);
        let said = &diagnostic.title;
        assert!(said.contains(title), "{text}: {said}");
        let shown = &text[diagnostic.span.clone()];
        assert!(place.is_empty() || shown == *place, "{text}: at `{shown}`");
    }
}

#[test]
fn what_is_no_formula_is_told_where_it_stands() {
    refuse(&[
        (
            "",
            "",
            "the formula ends where a number or a name should stand",
        ),
        (
            "3 m +",
            "+",
            "the formula ends where a number or a name should stand",
        ),
        ("(3 m", "(", "this parenthesis is not closed"),
        ("3 m)", ")", "expected an operator, found `)`"),
        (
            "sin 3",
            "sin",
            "the function `sin` has no arguments: `sin(…)`",
        ),
        (
            "sin()",
            ")",
            "expected a number or a name before it, found `)`",
        ),
        ("sim(3)", "sim", "unknown function `sim`"),
        ("min(3)", "min", "`min` takes two arguments"),
        ("sin(1, 2)", ",", "expected an operator or `)`, found `,`"),
        (
            "min(1, 2, 3)",
            ",",
            "expected an operator or `)`, found `,`",
        ),
        ("3 furlong", "furlong", "unknown unit `furlong`"),
        ("x y", "y", "expected an operator, found `y`"),
        ("x mm", "mm", "expected an operator, found `mm`"),
        ("mm * x", "mm", "the unit `mm` follows no number"),
        ("w", "w", "unknown name `w`"),
        ("3 * * 4", "*", "expected a number or a name, found `*`"),
    ]);
    let said = |text: &str, dimension| read(text, dimension).unwrap_err().title;
    assert!(said("z", 2).contains("unknown name `z`"));
    assert!(said("y0", 1).contains("unknown name `y0`"));
    assert!(read("x + x0 + r", 1).is_ok());
}

#[test]
fn parts_that_do_not_fit_are_told_where_they_stand() {
    refuse(&[
        ("x + 1 s", "x + 1 s", "cannot add a time to a length"),
        (
            "3 * (x - 1)",
            "x - 1",
            "cannot subtract a plain number from a length",
        ),
        ("sin(x)", "x", "`sin` takes a plain number, found a length"),
        (
            "2 * sqrt(x)",
            "x",
            "the square root of a length is no quantity",
        ),
        ("2^x", "x", "an exponent is a plain number, found a length"),
        (
            "x^0.5",
            "0.5",
            "the exponent of a length is a whole number of 9 at most",
        ),
        (
            "x^(x/x)",
            "(x/x)",
            "the exponent of a length is a whole number",
        ),
        (
            "max(x, 1 s)",
            "x, 1 s",
            "`max` compares a length with a time",
        ),
        (
            "20 °C * 2",
            "20 °C",
            "a temperature in °C can only be added to a difference",
        ),
        (
            "20 °C + 20 °C",
            "20 °C",
            "a temperature in °C can only be added",
        ),
        (
            "5 K - 20 °C",
            "20 °C",
            "a temperature in °C can only be added",
        ),
        (
            "abs(20 °C)",
            "20 °C",
            "a temperature in °C can only be added",
        ),
        ("1/0", "1/0", "this is no finite number"),
        ("ln(-1) * x", "-1", "this is no finite number"),
        ("1e400 m", "1e400 m", "`1e400 m` is too large"),
        ("10^999", "10^999", "this is no finite number"),
        (
            "x +\u{2003}",
            "\u{2003}",
            "the formula ends where a number or a name should stand",
        ),
        ("sin\u{2003}(1", "(", "this parenthesis is not closed"),
        ("0 s + x", "0 s + x", "cannot add a length to a time"),
        (
            "((1 m^9)^9)^9",
            "",
            "a quantity of such a dimension does not exist",
        ),
        ("x # y", "#", "expected an operator, found `#`"),
        ("é", "é", "unknown name `é`"),
        ("x + \u{202e}", "\u{202e}", "expected a number or a name"),
    ]);
}

#[test]
fn hostile_texts_are_refused_in_no_time() {
    for text in [
        "(".repeat(1000),
        "-".repeat(1000),
        "2^".repeat(500),
        "sin(".repeat(250),
        "x+(".repeat(300),
        "1*(".repeat(300),
        "m/(".repeat(300),
        format!("1 {}m{}", "(".repeat(400), ")".repeat(400)),
        format!("1{}", "/(m".repeat(300)),
        format!("x{}", "*x".repeat(400)),
        "min(x,".repeat(150),
        "1".repeat(1001),
        "\u{0}".to_owned(),
        "🦀".repeat(100),
    ] {
        assert!(read(&text, 3).is_err(), "{text}");
    }
    let sum = format!("x{}", "+x".repeat(400));
    assert!(read(&sum, 3).is_ok());
    let nested = format!("{}x{}", "(x+".repeat(31), ")".repeat(31));
    assert!(read(&nested, 3).is_ok());
    let nested = format!("{}x{}", "(x+".repeat(32), ")".repeat(32));
    assert!(read(&nested, 3).unwrap_err().title.contains("nested"));
}
