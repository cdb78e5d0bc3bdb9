//! Pages of runs: what stands in them, what they say of what is missing, and that a browser shows them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::program::{Ended, WHIPPLE, coarse_run, command, end, project};
use crate::python::python;
use tempfile::{TempDir, tempdir};

/// Markup that would run if a page took it for such.
const HOSTILE: &str =
    "</p></script><script>window.hostile=1</script><img src=x onerror=\"window.hostile=1\">";

/// A coarse run, with further options.
fn run(options: &[&str]) -> (TempDir, PathBuf) {
    let place = tempdir().unwrap();
    let folder = place.path().join("run");
    end(coarse_run(2, &folder).args(options)).with_code(0);
    (place, folder)
}

fn report(arguments: &[&Path], options: &[&str]) -> Ended {
    let mut report = command(WHIPPLE);
    end(report.arg("report").args(arguments).args(options))
}

/// The page of a run.
fn page(folder: &Path, options: &[&str]) -> String {
    let ended = report(&[folder], options).with_code(0);
    assert!(ended.stdout.starts_with("wrote "), "{ended:?}");
    fs::read_to_string(folder.join("report.html")).unwrap()
}

/// A section of a page.
#[track_caller]
fn section<'a>(page: &'a str, id: &str) -> &'a str {
    let (_, rest) = page
        .split_once(&format!("<section id=\"{id}\">"))
        .expect(id);
    rest.split_once("</section>").unwrap().0
}

/// How many particles each frame of the viewer shows.
fn frames(page: &str) -> Vec<u64> {
    let (_, rest) = page
        .split_once("<script id=\"scene\" type=\"application/json\">")
        .unwrap();
    let scene: serde_json::Value =
        serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap();
    let frames = scene["frames"].as_array().unwrap().iter();
    frames.map(|frame| frame["n"].as_u64().unwrap()).collect()
}

#[test]
fn a_page_tells_the_whole_run_and_the_same_one_each_time() {
    let measured = "measure.plate=[{ body = \"plate\" }]";
    let (_place, folder) = run(&["--set", measured, "--set", "fragments={}"]);
    let whole = page(&folder, &[]);
    for (id, told) in [
        ("verdict", "energy error"),
        ("pictures", "data:image/"),
        ("viewer", "id=\"frame2\""),
        ("case", "0.3 mm"),
        ("energies", "kinetic energy"),
        ("steps", "sound"),
        ("contacts", "plate – sphere"),
        ("measures", "hole diameter"),
        ("fragments", "largest mass"),
        ("load", "momentum"),
        ("environment", "ranks"),
        ("figures", "energy_error_max"),
    ] {
        assert!(
            section(&whole, id).contains(told),
            "{id}: {}",
            section(&whole, id)
        );
    }
    let verdict = section(&whole, "verdict");
    for word in [
        "mass defect",
        "momentum error",
        "nearest foreign pair",
        "✓ within",
        "0.28",
    ] {
        assert!(verdict.contains(word), "{verdict}");
    }
    assert!(
        !whole.contains("class=\"missing\">Not told"),
        "nothing is missing"
    );
    assert!(whole.contains("default-src 'none'; script-src 'sha256-"));
    assert!(!whole.contains("http://") && !whole.contains("https://"));
    assert!(whole.len() < 25_000_000, "{}", whole.len());
    assert_eq!(frames(&whole), [3056; 3]);

    assert!(
        page(&folder.join("../run"), &[]) == whole,
        "the same run, another page"
    );
    let few = page(&folder, &["--particles", "1000", "--frames", "2"]);
    let shown = frames(&few);
    assert!(
        shown.len() == 2 && shown.iter().all(|&n| n > 700 && n <= 1000),
        "{shown:?}"
    );
    assert!(few.len() < whole.len());
}

#[test]
fn texts_of_a_run_are_no_markup() {
    let (_place, folder) = run(&["--set", &format!("title={}", serde_json::json!(HOSTILE))]);
    make_hostile(&folder);
    let page = page(&folder, &[]);
    assert!(
        !page.contains("<script>window") && !page.contains("<img src=x"),
        "{page}"
    );
    assert!(page.contains("&lt;script&gt;window.hostile=1"));
    let told = section(&page, "contacts");
    assert!(told.contains("&lt;img src=x"), "{told}");
}

/// Changes texts of a run as nobody but a stranger would.
fn make_hostile(folder: &Path) {
    let change = |name: &str, from: &str, to: &str| {
        let path = folder.join(name);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{name}");
        fs::write(path, text.replace(from, to)).unwrap();
    };
    let quoted = format!("\"{}\"", HOSTILE.replace('"', "\"\""));
    change("contacts.csv", ",plate,", &format!(",{quoted},"));
    change("bodies.csv", ",sphere,", &format!(",{quoted},"));
    let json = serde_json::json!(HOSTILE).to_string();
    change(
        "summary.json",
        "\"instructions\": \"",
        &format!("\"mpi\": {json}, \"instructions\": \""),
    );
    change(
        "status.json",
        "\"state\"",
        &format!("\"reason\": {json}, \"state\""),
    );
}

#[test]
fn what_is_missing_or_damaged_is_named() {
    let (_place, folder) = run(&[]);
    let last = fs::read_dir(folder.join("snapshots")).unwrap().flatten();
    let last = last
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|e| e == "vtkhdf"));
    let last = last.max().unwrap();
    let content = fs::read(&last).unwrap();
    fs::write(&last, &content[..content.len() / 2]).unwrap();
    for (file, id, told) in [
        ("summary.json", "environment", "no summary.json"),
        ("bodies.csv", "verdict", "the run has no bodies.csv"),
        ("contacts.csv", "contacts", "the run has no contacts.csv"),
        ("performance.csv", "load", "the run has no performance.csv"),
        ("history.csv", "energies", "the run has no history.csv"),
        ("case.toml", "case", "the run has no case.toml"),
    ] {
        fs::remove_file(folder.join(file)).unwrap();
        let page = page(&folder, &[]);
        assert!(section(&page, id).contains(told), "{}", section(&page, id));
        assert!(
            section(&page, "pictures").contains("data:image/"),
            "of what is left"
        );
        let name = last.file_name().unwrap().to_str().unwrap();
        assert!(
            section(&page, "pictures").contains(name),
            "{}",
            section(&page, "pictures")
        );
        assert_eq!(frames(&page).len(), 2);
    }
    fs::write(folder.join("history.csv"), "time,dt\n0.0,1").unwrap();
    fs::write(folder.join("summary.json"), "{ no").unwrap();
    fs::write(folder.join("measures.csv"), "time\n").unwrap();
    fs::write(folder.join("fragments.csv"), "# units: s\ntime\n0.0\n").unwrap();
    fs::create_dir_all(folder.join("fragments")).unwrap();
    fs::write(folder.join("fragments/step-00000001.csv"), "mass\n").unwrap();
    fs::remove_dir_all(folder.join("snapshots")).unwrap();
    let page = page(&folder, &[]);
    assert!(section(&page, "steps").contains("history.csv has no column dt_reason"));
    assert!(section(&page, "figures").contains("summary.json is damaged"));
    assert!(section(&page, "viewer").contains("no snapshots"));
    assert!(section(&page, "measures").contains("Measures of the case"));
    assert!(section(&page, "load").contains("seconds_by_phase"));
    let fragments = section(&page, "fragments");
    assert!(
        fragments.contains("<table>") && fragments.contains("step-00000001.csv has no rows yet"),
        "{fragments}"
    );
    let path = folder.display().to_string();
    assert!(
        !page.contains(&path),
        "the way to a folder is another on each machine"
    );
}

#[test]
fn two_runs_stand_side_by_side() {
    let (place, one) = run(&[]);
    let other = place.path().join("softer");
    let set = [
        "--set",
        "material.aluminium.strength.von_mises.yield_stress=0.1 GPa",
    ];
    end(coarse_run(1, &other).args(set)).with_code(0);
    let ended = report(&[&one, &other], &[]).with_code(0);
    assert!(
        ended.stdout.contains("report-against-softer.html"),
        "{ended:?}"
    );
    let page = fs::read_to_string(one.join("report-against-softer.html")).unwrap();
    let case = section(&page, "case");
    assert!(
        case.contains("material.aluminium.strength.von_mises.yield_stress"),
        "{case}"
    );
    assert!(
        case.contains("0.26 GPa") && case.contains("0.1 GPa") && !case.contains("end_time"),
        "{case}"
    );
    let figures = section(&page, "figures");
    assert!(
        figures.contains("energy error max") && figures.contains(" %</span>"),
        "{figures}"
    );
    assert!(section(&page, "bodies").contains("kinetic energy"));
    assert!(section(&page, "curves").matches("data:image/").count() == 4);
    assert!(section(&page, "pictures").contains("data:image/"));

    end(command(WHIPPLE)
        .arg("report")
        .args([&one, &one])
        .args(["--out", "same.html"])
        .current_dir(place.path()))
    .with_code(0);
    let same = fs::read_to_string(place.path().join("same.html")).unwrap();
    assert!(section(&same, "case").contains("their cases are the same"));
    spoil_snapshots(&one, &other);
}

/// Two runs of which one has a snapshot that is cut off, then none at all.
fn spoil_snapshots(one: &Path, other: &Path) {
    let pictures = |told: [&str; 2]| {
        report(&[one, other], &[]).with_code(0);
        let page = fs::read_to_string(one.join("report-against-softer.html")).unwrap();
        let pictures = section(&page, "pictures");
        assert!(
            told.iter().all(|told| pictures.contains(told)),
            "{pictures}"
        );
        let way = one.parent().unwrap().display().to_string();
        assert!(!page.contains(&way), "the way to a folder");
    };
    let entries = fs::read_dir(other.join("snapshots")).unwrap().flatten();
    let all = entries.map(|entry| entry.path());
    let first = all
        .filter(|path| path.extension().is_some_and(|e| e == "vtkhdf"))
        .min()
        .unwrap();
    fs::write(&first, "no snapshot").unwrap();
    let name = first.file_name().unwrap().to_str().unwrap();
    pictures(["data:image/", name]);
    fs::remove_dir_all(other.join("snapshots")).unwrap();
    pictures(["Not told: softer has no snapshots", "that can be read"]);
}

#[test]
fn what_is_no_run_is_refused() {
    let place = tempdir().unwrap();
    let refused = |arguments: &[&Path], options: &[&str], told: &str| {
        let ended = report(arguments, options).with_code(2);
        assert!(ended.stderr.contains(told), "{ended:?}");
    };
    refused(&[place.path()], &[], "is neither a run folder");
    fs::write(place.path().join("status.json"), "{}").unwrap();
    refused(&[place.path()], &["--out", "page.pdf"], "ends in .html");
    refused(&[place.path()], &["--particles", "300001"], "300001");
    refused(&[place.path()], &["--frames", "0"], "--frames");
    refused(
        &[place.path(), place.path(), place.path()],
        &[],
        "no more were expected",
    );
    let page = page(place.path(), &[]);
    assert!(
        section(&page, "verdict").contains("No verdict"),
        "{}",
        section(&page, "verdict")
    );
}

#[test]
#[ignore = "slow"]
fn a_browser_shows_the_page_and_turns_the_model() {
    let Some(python) = python() else { return };
    let title = format!("title={}", serde_json::json!(HOSTILE));
    let (place, folder) = run(&["--set", &title]);
    make_hostile(&folder);
    page(&folder, &[]);
    report(&[&folder, &folder], &[]).with_code(0);
    let shots = place.path().join("shots");
    fs::create_dir(&shots).unwrap();
    let output = Command::new(python)
        .arg(project("tests/clients/page.py"))
        .args([folder.join("report.html"), shots.clone()])
        .arg(folder.join("report-against-run.html"))
        .output()
        .expect("python starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    for width in ["1280", "390"] {
        let size = fs::metadata(shots.join(format!("{width}.png")))
            .unwrap()
            .len();
        assert!(size > 50_000, "{width}: {size}");
    }
    eprintln!("{}", String::from_utf8_lossy(&output.stdout));
}
