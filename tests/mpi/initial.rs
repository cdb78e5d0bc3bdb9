//! Fields that bodies begin with have the same bits on any ranks and after a restart, and one that is
//! out of range is told once.

use std::fs;

use crate::program::{assert_same, end, ranks};

const CASE: &str = r#"
dimension = 3
spacing = "0.25 mm"
[run]
end_time = "0.6 us"
[output]
checkpoint_every = "0.2 us"
[material.copper]
library = "copper-johnson-cook"
[[body]]
name = "jet"
material = "copper"
shape.cylinder = { radius = "1 mm", length = "4 mm" }
velocity = ["20 m/s * sin(3 * y / 1 mm)", 0, "-1 km/s * (1 - 0.3 * (r / 2 mm)^2)"]
angular_velocity = { rate = [0, 0, "1e4 rad/s"], about = ["1 mm", 0, 0] }
temperature = "20 °C + 200 K * exp(-(x^2 + y^2) / 1 mm²)"
plastic_strain = "0.05 * (1 + cos(pi * z / 2 mm))"
[[body]]
name = "plate"
material = "copper"
shape.box.size = ["4 mm", "4 mm", "1 mm"]
touch = { body = "jet", direction = "+z" }
specific_energy = "20 kJ/kg * step(x)"
"#;

#[test]
fn fields_have_the_same_bits_on_any_ranks_and_after_a_restart() {
    let place = tempfile::tempdir().unwrap();
    let at = |name: &str| place.path().join(name);
    let case = at("case.toml");
    fs::write(&case, CASE).unwrap();
    let run = |number: usize, name: &str, more: &[&str]| {
        let mut command = ranks(number);
        command
            .arg("run")
            .arg(&case)
            .args(["--poison", "--threads", "1"]);
        command.args(more).arg("--out").arg(at(name));
        end(&mut command).with_code(0)
    };
    run(1, "one", &[]);
    for number in [2, 3] {
        let name = format!("on {number}");
        run(number, &name, &[]);
        assert_same(&at("one"), &at(&name));
    }
    run(2, "legs", &["--until", "0.25us"]);
    let mut again = ranks(1);
    again.arg("restart").arg(at("legs")).arg("--poison");
    end(&mut again).with_code(0);
    assert_same(&at("one"), &at("legs"));
}

#[test]
fn a_field_out_of_range_is_told_once() {
    let place = tempfile::tempdir().unwrap();
    let case = place.path().join("case.toml");
    let text = CASE.replace("0.25 mm", "0.05 mm").replace(
        "20 kJ/kg * step(x)",
        "20 kJ/kg / step(x^2 + y^2 - 1e-4 mm^2 * (50 * 50))",
    );
    // All are out of range within half a millimetre of the axis; the survey passes over such.
    fs::write(&case, text).unwrap();
    for number in [1, 2] {
        let mut command = ranks(number);
        command
            .arg("run")
            .arg(&case)
            .arg("--out")
            .arg(place.path().join("out"));
        let ended = end(&mut command);
        let told = "`specific_energy` of `plate` is inf J/kg at [";
        assert_eq!(ended.stderr.matches(told).count(), 1, "{ended:#?}");
        assert!(ended.code.is_some_and(|code| code != 0), "{ended:#?}");
    }
}
