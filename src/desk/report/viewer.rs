//! The viewer of particles: its controls, its script and the frames that it shows.

mod chosen;
mod frames;
mod scene;

use std::path::PathBuf;

use serde_json::json;

use super::html::{Html, note, swatch};
use super::run_files::{Run, with_unit};
use model::SymmetryPlane;
use model::readable::short;
use plot::hex;
use scene::Scene;

/// The script of the browser.
pub const SCRIPT: &str = include_str!("viewer.js");

/// The viewer of some snapshots (time in s, path) in at most `room` bytes, unless frames are asked for: all
/// particles, or `particles` of them.
pub fn render(
    run: &Run,
    snapshots: &[(f64, PathBuf)],
    particles: usize,
    frames: Option<usize>,
    room: usize,
) -> Result<Html, String> {
    let scene = Scene::read(snapshots, particles, frames, room);
    let scene = scene.map_err(|error| run.without_path(&error))?;
    let mut page = Html::element(
        "div",
        &[("id", "no-viewer"), ("class", "missing")],
        Html::text(
            "The viewer needs WebGL 2, scripts and a browser of 2023 or later, and this one does not offer \
         them. All else of the page stands without; the sections above show the same model.",
        ),
    );
    let inside = stage().then(controls(&scene));
    page.push(Html::element(
        "div",
        &[("id", "live"), ("hidden", "")],
        inside,
    ));
    page.push(note(&words(&scene, snapshots.len())));
    page.push(Html::data(
        "scene",
        "application/json",
        &data(&scene).to_string(),
    ));
    for (k, frame) in scene.frames.iter().enumerate() {
        page.push(Html::data(
            &format!("frame{k}"),
            "application/octet-stream",
            &frame.packed,
        ));
    }
    Ok(page)
}

/// The share of the run that the viewer has.
fn words(scene: &Scene, snapshots: usize) -> String {
    let amount = if scene.kept < scene.total {
        format!(
            "{} of {} particles are shown, chosen by their ids, each {} times as large",
            scene.kept,
            scene.total,
            short((100.0 * scene.enlarge).round() / 100.0)
        )
    } else {
        format!("All {} particles are shown", scene.total)
    };
    format!(
        "{amount}; {} of {snapshots} snapshots. Places are kept to 1/65536 of the box of a frame, values to \
         1/254 of their range. Beyond the ends of a scale colours are those of its ends; pink is no number. \
         Keys, once the picture is chosen: arrows turn, + and − zoom, space plays, comma and full stop step, \
         Home goes back. Mouse: drag turns, with Shift moves, the wheel zooms. Touch: one finger turns, two zoom \
         and move.",
        scene.frames.len()
    )
}

/// The picture.
fn stage() -> Html {
    let label = "Particles of the model in three dimensions; arrow keys turn, plus and minus zoom, space plays";
    let canvas = [
        ("id", "canvas"),
        ("tabindex", "0"),
        ("role", "img"),
        ("aria-label", label),
    ];
    let clock = Html::element("output", &[("id", "clock")], Html::default());
    let inside = Html::element("canvas", &canvas, Html::default()).then(clock);
    Html::element("div", &[("class", "stage")], inside).then(Html::own(
        "<div id=\"legend\" hidden><span id=\"legend-name\"></span><div id=\"ramp\"></div><div id=\"ticks\"></div></div>",
    ))
}

fn controls(scene: &Scene) -> Html {
    let rows = [time(scene), colours_and_cut(scene), boxes(scene)];
    Html::element("div", &[("class", "controls")], rows.into_iter().collect())
}

/// Time: play, and a slider.
fn time(scene: &Scene) -> Html {
    let last = (scene.frames.len() - 1).to_string();
    let slider = [
        ("id", "time"),
        ("type", "range"),
        ("min", "0"),
        ("max", last.as_str()),
        ("value", last.as_str()),
        ("aria-label", "Time"),
    ];
    let row = Html::own("<button id=\"play\" type=\"button\">▶ Play</button>")
        .then(Html::element("input", &slider, Html::default()))
        .then(Html::own(
            "<button id=\"home\" type=\"button\">Reset view</button>",
        ));
    Html::element("div", &[("class", "row time")], row)
}

/// The choice of colours, and a plane that cuts.
fn colours_and_cut(scene: &Scene) -> Html {
    let option = |(k, name): (usize, &str)| {
        Html::element("option", &[("value", &k.to_string())], Html::text(name))
    };
    let names = scene.fields.iter().map(|field| field.name.as_str());
    let options = ["body"].into_iter().chain(names).enumerate().map(option);
    let select = Html::element("select", &[("id", "colour")], options.collect());
    let row = Html::element("label", &[], Html::own("Colour by ").then(select)).then(Html::own(
        "<span class=\"together\"><label>Cut <select id=\"cut\"><option value=\"-1\">nothing</option>\
         <option value=\"0\">along x</option><option value=\"1\">along y</option>\
         <option value=\"2\">along z</option></select></label>\
         <input id=\"cut-at\" type=\"range\" min=\"0\" max=\"1000\" value=\"500\" aria-label=\"Place of the cut\">\
         <output id=\"cut-place\"></output>\
         <label><input id=\"other-side\" type=\"checkbox\">other side</label></span>",
    ));
    Html::element("div", &[("class", "row")], row)
}

/// Bodies that are seen, and planes that mirror: one is left open, so that the inside is seen.
fn boxes(scene: &Scene) -> Html {
    let mut row = Html::default();
    for (k, body) in scene.bodies.iter().enumerate() {
        let inside = swatch(body.colour).then(Html::text(&body.name));
        row.push(check("data-body", k, true, inside));
    }
    for (k, plane) in scene.mirrors.iter().enumerate() {
        let (axis, position) = (plane.axis.name(), with_unit(plane.position, "m"));
        let name = Html::text(&format!("mirror in {axis} = {position}"));
        row.push(check("data-mirror", k, k + 1 < scene.mirrors.len(), name));
    }
    Html::element("div", &[("class", "row")], row)
}

/// A box to tick, with its number.
fn check(attribute: &'static str, number: usize, ticked: bool, label: Html) -> Html {
    let number = number.to_string();
    let mut attributes = vec![("type", "checkbox"), (attribute, number.as_str())];
    if ticked {
        attributes.push(("checked", ""));
    }
    Html::element(
        "label",
        &[],
        Html::element("input", &attributes, Html::default()).then(label),
    )
}

/// The data of the scene for the script.
fn data(scene: &Scene) -> serde_json::Value {
    let frame = |frame: &frames::Frame| {
        json!({
            "n": frame.count,
            "time": with_unit(frame.time, "s"),
            "lower": frame.lower,
            "upper": frame.upper,
        })
    };
    let field = |field: &scene::Field| json!({ "name": field.name, "ticks": field.ticks, "stops": field.stops });
    let mirror =
        |plane: &SymmetryPlane| json!({ "axis": plane.axis.index(), "position": plane.position });
    let body = |body: &scene::Shade| json!({ "name": body.name, "colour": hex(body.colour) });
    json!({
        "dimension": scene.dimension,
        "yaw": scene.yaw,
        "lower": scene.lower,
        "upper": scene.upper,
        "reach": scene.reach,
        "size": scene.size,
        "enlarge": scene.enlarge,
        "unit": { "size": scene.unit.size, "name": scene.unit.name },
        "frames": scene.frames.iter().map(frame).collect::<Vec<_>>(),
        "fields": scene.fields.iter().map(field).collect::<Vec<_>>(),
        "mirrors": scene.mirrors.iter().map(mirror).collect::<Vec<_>>(),
        "bodies": scene.bodies.iter().map(body).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::SCRIPT;

    #[test]
    fn the_script_is_small() {
        assert!(SCRIPT.len() <= 15_000, "{} bytes", SCRIPT.len());
        assert!(!SCRIPT.contains("</script"), "it would end where it stands");
    }
}
