//! Ballistic limits from the command line: tables, charts, and a sweep beside an equation.

use std::path::Path;

use crate::program::{WHIPPLE, command, end, quarter_impact};

const SHIELD: [&str; 8] = [
    "--bumper", "1.2mm", "--wall", "3.2mm", "--gap", "100mm", "--yield", "40ksi",
];

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn an_equation_is_printed_written_and_drawn() {
    let place = tempfile::tempdir().unwrap();
    let [csv, png] = ["nno.csv", "new/nno.png"].map(|name| place.path().join(name));
    let mut limit = command(WHIPPLE);
    limit.args(["limit", "nno"]).args(SHIELD);
    limit.args(["--speeds", "3, 5, 7 km/s"]);
    limit.arg("--csv").arg(&csv).arg("--plot").arg(&png);
    let ended = end(&mut limit).with_code(0);
    for line in [
        "       3           2.287 mm  ballistic",
        "       5           3.988 mm  shatter",
        "       7           5.690 mm  hypervelocity",
        "Source: Christiansen 1993",
    ] {
        assert!(ended.stdout.contains(line), "{}", ended.stdout);
    }
    let table = text(&csv);
    assert!(
        table.starts_with("# units: m/s,m,-\nspeed,critical_diameter,remark\n3000.0,0.00228"),
        "{table}"
    );
    assert!(std::fs::read(&png).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn what_makes_no_sense_is_refused() {
    let wrong: [(&[&str], &str); 6] = [
        (&["nno", "--bumper", "1.2"], "unit of m"),
        (&["nno", "--bumper", "0mm"], "positive"),
        (&["nno", "--angle", "90deg"], "below 90 deg"),
        (&["nno", "--speeds", "0, 3 km/s"], "positive"),
        (&["nno", "--plot", "nno.pdf"], ".png or .svg"),
        (&["nno", "--sweep", "nowhere"], "no sweep"),
    ];
    for (args, why) in wrong {
        let mut limit = command(WHIPPLE);
        limit.arg("limit").args(args);
        for pair in SHIELD.chunks(2).filter(|pair| !args.contains(&pair[0])) {
            limit.args(pair);
        }
        let ended = end(&mut limit).with_code(2);
        assert!(ended.stderr.to_lowercase().contains(why), "{ended:#?}");
    }
}

/// The small sphere is stopped, the large one is not; the equation says the same of both.
#[test]
fn the_runs_of_a_sweep_stand_beside_an_equation() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    let mut sweep = command(WHIPPLE);
    sweep.args(["sweep", &quarter_impact(), "--set", "spacing=0.1mm"]);
    sweep.args(["--set", "run.end_time=0.6us", "--threads", "1"]);
    sweep.args(["--set", "body.sphere.velocity=[0, 0, \"-0.5 km/s\"]"]);
    sweep.args(["--vary", "body.sphere.shape.sphere.radius=0.12, 0.5 mm"]);
    end(sweep.arg("--out").arg(&out)).with_code(0);
    let mut limit = command(WHIPPLE);
    limit.args(["limit", "crater", "--wall", "0.5mm", "--brinell", "105"]);
    limit.args(["--sound-speed", "5.33km/s", "--speeds", "0.4..1 km/s"]);
    let ended = end(limit.arg("--sweep").arg(&out).args(["--format", "svg"])).with_code(0);
    let lines: Vec<&str> = ended.stdout.lines().collect();
    for (diameter, verdict) in [("0.240 mm", "held    held"), ("1.000 mm", "failed  failed")] {
        let found = lines
            .iter()
            .find(|line| line.contains(diameter) && line.contains(verdict));
        assert!(found.is_some(), "{}", ended.stdout);
    }
    assert!(ended.stdout.contains("agree on 2 of 2"), "{}", ended.stdout);
    assert!(text(&out.join("limit.svg")).contains(">failed</text>"));
    let mut limit = command(WHIPPLE);
    limit.args(["limit", "nno"]).args(SHIELD);
    limit.args(["--projectile", "plate"]);
    let ended = end(limit.arg("--sweep").arg(&out)).with_code(2);
    assert!(ended.stderr.contains("no ball `plate`"), "{ended:#?}");
}
