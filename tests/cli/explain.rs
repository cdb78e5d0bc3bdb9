//! `whipple check --explain`: a case key by key.

use std::fs;

use crate::program::{WHIPPLE, command, end};

/// Each key with its value and origin; what is printed is a case that gives the same again.
#[test]
fn a_case_is_explained_key_by_key() {
    let place = tempfile::tempdir().unwrap();
    let case = place.path().join("case.toml");
    let text = "title = \"Cubes\"\ndimension = 3\nspacing = \"0.1 mm\"\n\
                material.metal.library = \"copper\"\nmaterial.metal.density = \"8.9 g/cm^3\"\n\
                material.metal.failure.spall.pressure = \"-1 GPa\"\n\
                [run]\nend_time = \"1 us\"\n\
                [[body]]\nname = \"one\"\nmaterial = \"metal\"\n\
                shape.box = { lower = [0, 0, 0], upper = [\"1 mm\", \"1 mm\", \"1 mm\"] }\n\
                [[body]]\nname = \"two\"\nmaterial = \"metal\"\nvelocity = [0, 0, \"-1 km/s\"]\n\
                shape.sphere = { centre = [0, 0, \"2 mm\"], radius = \"0.5 mm\" }\n\
                [output]\nsnapshot_every = \"0.5 us\"\n";
    fs::write(&case, text).unwrap();
    let path = case.to_str().unwrap();
    let explain = |path: &str, more: &[&str]| {
        let mut check = command(WHIPPLE);
        check.args(["check", path, "--explain"]).args(more);
        end(&mut check).with_code(0).stdout
    };
    let set = [
        "--set",
        "body.two.shape.sphere.radius=0.4 mm",
        "--set",
        "sph.alpha=0.7",
    ];
    let told = explain(path, &set);
    let line = |begin: &str, end: &str| {
        let found = told
            .lines()
            .any(|line| line.starts_with(begin) && line.ends_with(end));
        assert!(found, "{begin} {end}: {told}");
    };
    line("title = \"Cubes\" ", &format!("# {path}:1"));
    line("end_time = \"1 us\" ", &format!("# {path}:8"));
    line("shape.sphere.radius = \"0.4 mm\" ", "# --set");
    line("alpha = 0.7 ", "# --set");
    line("# beta = 2 ", "# default");
    line("# time_step.courant ", "with a body in the total form");
    line("# time_step.max ", "but what materials demand");
    line("# history_every ", "# default: 250 rows a run");
    line("density = \"8.9 g/cm^3\" ", &format!("# {path}:5"));
    line("# strength", "# library");
    // Copper of the library does not fail.
    line("# failure.spall.after = \"failed\" ", "# default");
    assert_eq!(told.matches("failure.spall.after").count(), 1, "{told}");
    line("# density ", "# default: the material's reference density");

    // Without origins, which hang on the text, it explains itself.
    let again = place.path().join("again.toml");
    fs::write(&again, &told).unwrap();
    let again = explain(again.to_str().unwrap(), &[]);
    let bare = |text: &str| -> Vec<String> {
        let parts = text
            .lines()
            .map(|line| line.rsplit_once("  # ").map_or(line, |(key, _)| key));
        parts.map(|key| key.trim_end().to_owned()).collect()
    };
    let (mut told, mut again) = (bare(&told), bare(&again));
    told.sort();
    again.sort();
    assert_eq!(told, again);
    // What is wrong is shown as ever.
    let wrong = end(command(WHIPPLE).args(["check", path, "--explain", "--set", "sph.alfa=1"]));
    assert!(wrong.with_code(2).stderr.contains("did you mean `alpha`?"));
}
