//! Numbers with units, and where they end.

use super::*;

#[test]
fn units_compose() {
    assert_eq!(parse("896 J/(kg K)").unwrap(), (896.0, [2, 0, -2, -1, 0]));
    assert_eq!(parse("3.5 kJ/g").unwrap(), (3.5e6, [2, 0, -2, 0, 0]));
    assert_eq!(parse("1 g/(cm us^2)").unwrap(), (1e11, [-1, 1, -2, 0, 0]));
    assert_eq!(parse("1 g cm^-1·us^-2").unwrap(), (1e11, [-1, 1, -2, 0, 0]));
    assert_eq!(parse("6.5 /s").unwrap(), (6.5, [0, 0, -1, 0, 0]));
    assert_eq!(parse("2/Mbar").unwrap(), (2e-11, [1, -1, 2, 0, 0]));
    assert!(parse("1/").unwrap_err().contains("ends too early"));
    assert_eq!(parse("300 K").unwrap(), (300.0, [0, 0, 0, 1, 0]));
    assert_eq!(parse("-.5").unwrap(), (-0.5, [0; 5]));
}

#[test]
fn units_of_inches_and_pounds_are_rounded_once() {
    for (text, si) in [
        ("1 in", 0.0254),
        ("0.5 in", 0.0127),
        ("-12 in", -0.3048),
        ("3 ft", 0.9144),
        ("1e3 ft/s", 304.8),
        ("0.1 in^2", 6.4516e-5),
        ("1 psi", 6_894.757_293_168_361),
        ("145.037737730209 psi", 1e6),
        ("50 ksi", 344_737_864.658_418_06),
        ("10 Mpsi", 68_947_572_931.683_61),
        ("0.098 lb/in^3", 2_712.630_661_599_906),
        ("5 min", 300.0),
        ("2 lb", 0.907_184_74),
    ] {
        let parsed = parse(text).unwrap().0;
        assert!((parsed / si - 1.0).abs() < 1e-14, "{text}: {parsed}");
    }
    for (text, si) in [("0.3 in", 0.00762), ("0.02 in", 5.08e-4), ("7 ft", 2.1336)] {
        assert_eq!(parse(text).unwrap().0.to_bits(), f64::to_bits(si), "{text}");
    }
    assert!(parse(&format!("{} ft^9", "9".repeat(190))).is_ok());
    assert!(parse("1e200 ft^9").is_ok());
    assert!(parse("1e400 ft").unwrap_err().contains("too large"));
}

#[test]
fn a_degree_celsius_alone_is_a_temperature_and_in_a_product_a_difference() {
    let kelvin = [0, 0, 0, 1, 0];
    assert_eq!(parse("20 °C").unwrap(), (293.15, kelvin));
    assert_eq!(parse("-273.15 degC").unwrap(), (0.0, kelvin));
    assert_eq!(parse("0°C").unwrap(), (273.15, kelvin));
    assert_eq!(parse("20 (°C)").unwrap(), (293.15, kelvin));
    assert_eq!(parse("20 K").unwrap(), (20.0, kelvin));
    assert_eq!(parse("2 /°C").unwrap(), (2.0, [0, 0, 0, -1, 0]));
    let heat = parse("896 J/(kg K)").unwrap();
    assert_eq!(parse("896 J/(kg °C)").unwrap(), heat);
    assert_eq!(parse("896 J/kg/degC").unwrap(), heat);
    assert_eq!(parse("5 °C m/m").unwrap(), (5.0, kelvin));
    assert_eq!(unit_of("20 °C"), 1.0);
    assert_eq!(unit_of("0.02 in"), 0.0254);
    for wrong in ["20 deg C", "20 °F", "20 C", "20 °"] {
        let read = parse(wrong);
        assert!(read.is_err() || read.unwrap().1 != kelvin, "{wrong}");
    }
}

#[test]
fn a_unit_goes_as_far_as_symbols_of_units_do() {
    let velocity = [1, 0, -1, 0, 0];
    for (text, value, powers, length) in [
        ("3 km/s * (1 - x)", 3e3, velocity, 6),
        ("3 km/s*x", 3e3, velocity, 6),
        ("5 mm)^2", 5e-3, [1, 0, 0, 0, 0], 4),
        ("5 mm^2)", 5e-6, [2, 0, 0, 0, 0], 6),
        ("5 J/(kg K) * x", 5.0, [2, 0, -2, -1, 0], 10),
        ("5 J/(kg x)", 5.0, [2, 1, -2, 0, 0], 3),
        ("1/s", 1.0, [0, 0, -1, 0, 0], 3),
        ("1 / 3 s", 1.0, [0; 5], 1),
        ("1 / x", 1.0, [0; 5], 1),
        ("2 min(x, y)", 2.0, [0; 5], 1),
        ("2 min", 120.0, [0, 0, 1, 0, 0], 5),
        ("20 °C + 3 K", 293.15, [0, 0, 0, 1, 0], 6),
        ("5 K/mm * z", 5e3, [-1, 0, 0, 1, 0], 6),
        ("2 m s", 2.0, [1, 0, 1, 0, 0], 5),
        (".5", 0.5, [0; 5], 2),
        ("2e3x", 2e3, [0; 5], 3),
    ] {
        let parsed = leading(text).unwrap();
        assert_eq!(parsed.value, value, "{text}");
        assert_eq!((parsed.powers, parsed.length), (powers, length), "{text}");
    }
    assert!(leading("20 °C").unwrap().celsius);
    assert!(!leading("20 °C/m").unwrap().celsius);
    assert_eq!(leading("x"), None);
    assert_eq!(leading("-3"), None);
}

#[test]
fn a_number_stands_before_its_unit() {
    assert_eq!(split(" 0.1mm "), Some(("0.1", "mm")));
    assert_eq!(split("-2e3 kg/m^3"), Some(("-2e3", "kg/m^3")));
    assert_eq!(split("3"), Some(("3", "")));
    assert_eq!(split("mm"), None);
}
