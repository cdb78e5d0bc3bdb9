//! `whipple plot`: pictures from a snapshot or a run folder.

mod curves;
mod each;
mod movie;
pub(super) mod out;
mod scene;

use std::collections::BTreeSet;
use std::ffi::{OsStr, OsString};
use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use serde_json::json;

use super::output_format::OutputFormat;
use super::which::Several;
use files::FileOpener;
use movie::MovieArgs;
use out::{target, write_chart};
use plot::{
    Along, History, Pictures, PlotError, ProfileRequest, Profiles, Request, Source, Wanted,
};
use scene::SceneArgs;

/// Draw sections, views and radiographs of snapshots, profiles along a line, energies or tables as SVG or
/// PNG pictures, and movies
///
/// A section shows the matter that a plane cuts, coloured by body or by a field, with the bodies'
/// outlines. A run's last snapshot is drawn unless others are asked for.
/// With --profile the particles of one row along a line are drawn as dots over their coordinate.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = "Examples:
  whipple plot runs/impact                                   last snapshot, by body
  whipple plot runs/impact --field pressure --time 0.1us
  whipple plot runs/impact --panels --time 0us,0.1us,0.2us   side by side
  whipple plot runs/impact --all --field velocity.z --range -7:1km/s
  whipple plot state.vtkhdf --section z=0.1mm --view -1:1,-1:1mm
  whipple plot runs/impact --view isometric                  the whole model, cut open
  whipple plot runs/impact --view 30,-15 --cut y=0 --field velocity
  whipple plot runs/impact --radiograph y
  whipple plot runs/impact --view isometric --movie cloud.gif
  whipple plot runs/impact --history --out energies.svg      lines and text for a paper
  whipple plot runs/impact --fragments --all
  whipple plot runs/impact --distributions --time 5us,10us
  whipple plot runs/bars --profile stress.xx --at 0.48us --exact
  whipple plot runs/bars --profile velocity.x --with runs/bars-kernel
  whipple plot runs/dam --front water --points martin-moyce.csv
  whipple plot runs/impact --front plate --along -z
  whipple plot runs/impact/contacts.csv --pair plate,sphere
  whipple plot runs/impact --gauges front,rear --xy time:normal_stress
  whipple plot errors.csv --xy spacing:error --log xy")]
#[expect(
    clippy::struct_excessive_bools,
    clippy::doc_markdown,
    reason = "each is a switch of the command line; the comments are its help"
)]
pub struct PlotArgs {
    /// Snapshot file (.vtkhdf), run folder, or table (.csv) for --history, --xy and --pair
    #[arg(value_name = "FILE_OR_RUN")]
    pub source: PathBuf,

    /// File to write if the name ends in .png, .svg or .csv, else the folder to write into (with / at
    /// its end if it has an ending of letters) [default: beside the snapshot, or RUN/pictures]
    #[arg(short, long, value_name = "FILE_OR_FOLDER")]
    pub out: Option<PathBuf>,

    #[command(flatten)]
    picture: out::PictureFormat,

    /// Write what would be drawn as a table of comma-separated values instead, in SI units: the points of
    /// curves, of a section its grid of pixels or its particles
    #[arg(long, conflicts_with = "format")]
    pub csv: bool,

    /// What colours show: "body", a field, FIELD.COMPONENT (x, y, z, magnitude; xx … xz,
    /// von_mises) or "von_mises" [default: body]
    #[arg(short, long, value_name = "NAME")]
    pub field: Option<String>,

    /// Plane of the section, as in y=0.1mm; with the axis alone its plane of symmetry or the
    /// middle [default: z of a flat model, else a plane along the impact, through the body that
    /// moves most against the rest: a plane of symmetry if one cuts it, else its middle]
    #[arg(short, long, value_name = "AXIS=POSITION", allow_hyphen_values = true)]
    pub section: Option<String>,

    /// How a section is drawn: "cut" shows matter, "particles" those of a slice as discs of the
    /// particle spacing [default: cut; with --thickness particles]
    #[arg(long = "as", value_name = "cut|particles", value_parser = ["cut", "particles"])]
    pub drawn_as: Option<String>,

    /// Thickness of a slice of particles, or of a profile's line, as in 0.1mm [default: one
    /// particle spacing, two on a plane of symmetry: one layer of a cubic lattice; of a line one
    /// and a half, for the rows beside it]
    #[arg(long, value_name = "LENGTH")]
    pub thickness: Option<String>,

    /// Reflect the model at its planes of symmetry (this is the default)
    #[arg(long, overrides_with = "no_mirror")]
    pub mirror: bool,

    /// Show only the part that was computed
    #[arg(long)]
    pub no_mirror: bool,

    /// Values at the ends of the colour bar, or of the upward axis of a profile or table, as in
    /// 0:100GPa [default: all values; of colours all but a few outliers]
    #[arg(long, value_name = "LOW:HIGH", allow_hyphen_values = true)]
    pub range: Option<String>,

    /// From where to see the whole model: isometric, front, back, left, right, top, bottom, or
    /// AZIMUTH,ELEVATION of the viewer in degrees, 0,0 at the front and 90,0 at the right. Or part of
    /// the plane to draw, as in -1:1,0:2mm, or of a profile's line or a table's axis to the right, as
    /// in -1:1mm [default: a section, and all of it]
    #[arg(
        long,
        value_name = "NAME|LEFT:RIGHT[,BOTTOM:TOP]",
        allow_hyphen_values = true
    )]
    pub view: Option<String>,

    /// Width of the picture in pixels [default: 1200, panels 1800]
    #[arg(long, value_name = "PX", value_parser = clap::value_parser!(u32).range(400..=20_000))]
    pub width: Option<u32>,

    /// The snapshots of a run.
    #[command(flatten)]
    pub which: Several,

    /// Draw the snapshots side by side in one picture [default: the first, middle and last]
    #[arg(long)]
    pub panels: bool,

    /// Further runs, snapshots or tables in the same picture: beside the first with --panels, over
    /// it with --profile, --history and --xy
    #[arg(long, value_name = "FILE_OR_RUN", value_delimiter = ',')]
    pub with: Vec<PathBuf>,

    /// Draw what the run's tables tell over time instead: its "energies", each "time-step" by what limits
    /// it, "momentum", "defect" (energy that nothing accounts for), "load" of the busiest rank over the
    /// mean [default: energies]
    #[arg(
        long,
        value_name = "WHAT",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = History::Energies.name(),
        value_parser = history(),
        conflicts_with_all = [
            "which", "field", "section", "drawn_as", "thickness", "no_mirror", "panels", "range", "view",
        ],
    )]
    pub history: Option<History>,

    /// Draw how many fragments of the run are as heavy, and how many as large, as any, instead: one
    /// picture each, of the last time that the run has told them unless others are asked for; or of
    /// a table that `whipple fragments --csv` has written
    #[arg(long, conflicts_with_all = [
        "field", "section", "drawn_as", "thickness", "no_mirror", "panels", "range", "view", "history",
    ])]
    pub fragments: bool,

    /// Draw what the run's distributions.csv tells instead, one picture each: mass by speed and by angle, profiles of
    /// craters and bars; of the last time that the run has told them unless others are asked for
    #[arg(long, conflicts_with_all = [
        "field", "section", "drawn_as", "thickness", "no_mirror", "panels", "range", "view", "history", "fragments",
    ])]
    pub distributions: bool,

    /// Draw a field along a line instead: FIELD or FIELD.COMPONENT, as for --field; stress.xx … is
    /// all that matter bears, that by contact too, `material_stress.xx` … without
    #[arg(long, value_name = "FIELD", group = "line", conflicts_with_all = [
        "field", "section", "drawn_as", "no_mirror", "panels", "history",
    ])]
    pub profile: Option<String>,

    /// Axis of the profile's line, or r for the distance from a point; axis of the front, or -x,
    /// -y, -z for the one against it
    #[arg(
        long,
        value_name = "x|y|z|r",
        requires = "line",
        default_value = "x",
        allow_hyphen_values = true
    )]
    pub along: String,

    /// Where the profile's line crosses the other axes, or the point, as in y=0,z=0.1mm [default:
    /// planes of symmetry, else the middle of the model]
    #[arg(
        long,
        value_name = "AXIS=POSITION",
        requires = "profile",
        allow_hyphen_values = true
    )]
    pub through: Option<String>,

    /// Draw the exact answer over the profile, where one is known
    #[arg(long, requires = "profile")]
    pub exact: bool,

    /// Draw columns of a table (of a run: history.csv) against another: X:Y or X:Y,Y2; "force" is
    /// the magnitude of force_x, force_y, force_z. Pairs of bodies, loads and bodies are lines of
    /// their own [default of contacts.csv: time:force]
    #[arg(long, value_name = "X:Y", conflicts_with_all = [
        "which", "field", "section", "drawn_as", "thickness", "no_mirror", "panels", "history", "profile",
    ])]
    pub xy: Option<String>,

    /// Draw the forces of one pair of bodies of contacts.csv, or what --xy says: those on the first
    /// that the table names
    #[arg(long, value_name = "BODY,BODY", conflicts_with_all = [
        "which", "field", "section", "drawn_as", "thickness", "no_mirror", "panels", "history", "profile", "front",
    ])]
    pub pair: Option<String>,

    /// Draw what gauges of a run have read, those of these names, against time: their pressure, or what
    /// --xy says
    #[arg(long, value_name = "NAME", value_delimiter = ',', conflicts_with_all = [
        "which", "field", "section", "drawn_as", "thickness", "no_mirror", "panels", "history", "profile", "front",
        "pair",
    ])]
    pub gauges: Vec<String>,

    /// Draw how far a body reaches along an axis over time, and write it as a table: the largest
    /// coordinate of its largest piece, of particles within one and a half spacings; against the
    /// axis the smallest
    #[arg(long, value_name = "BODY", group = "line", conflicts_with_all = [
        "which", "field", "section", "drawn_as", "thickness", "no_mirror", "panels", "history", "profile", "xy",
    ])]
    pub front: Option<String>,

    /// Points of other tables, drawn as rings over --xy or --front; their columns if they have
    /// other names
    #[arg(long, value_name = "FILE[:X:Y]")]
    pub points: Vec<String>,

    /// Logarithmic axes of --xy
    #[arg(long, value_name = "x|y|xy", requires = "xy", value_parser = ["x", "y", "xy"])]
    pub log: Option<String>,

    /// Options of views and radiographs.
    #[command(flatten)]
    pub scene: SceneArgs,

    /// Options of movies.
    #[command(flatten)]
    pub movie: MovieArgs,

    /// Form of the output.
    #[command(flatten)]
    pub format: OutputFormat,
}

fn history() -> impl TypedValueParser<Value = History> {
    let of = |name: String| History::ALL.into_iter().find(|kind| kind.name() == name);
    PossibleValuesParser::new(History::ALL.map(History::name))
        .map(move |name| of(name).unwrap_or(History::Energies))
}

/// Draws what the arguments of a command line ask for.
pub(super) fn by_words<const N: usize>(words: [OsString; N]) -> Result<(), String> {
    #[derive(clap::Parser)]
    struct Words {
        #[command(flatten)]
        args: PlotArgs,
    }
    let all = ["plot".into()].into_iter().chain(words);
    let words = <Words as clap::Parser>::try_parse_from(all).map_err(|error| error.to_string())?;
    run(&words.args).map_err(|error| error.to_string())
}

/// Makes the pictures and prints their paths.
///
/// # Errors
/// [`PlotError`] if an input cannot be read, a request cannot be met or a picture not written.
pub fn run(args: &PlotArgs) -> Result<(), PlotError> {
    args.format.begin();
    draw(args)?;
    args.format.print(|| json!({}));
    Ok(())
}

fn draw(args: &PlotArgs) -> Result<(), PlotError> {
    out::check(args)?;
    scene::check(args)?;
    movie::check(args)?;
    if let Some(history) = args.history {
        curves::draw_history(args, history)
    } else if args.fragments {
        curves::draw_fragments(args)
    } else if args.distributions || curves::is_distributions(args) {
        curves::draw_distributions(args)
    } else if let Some(body) = &args.front {
        curves::draw_front(args, body)
    } else if curves::is_table(args) {
        curves::draw_tables(args, &curves::columns(args)?)
    } else if !args.points.is_empty() {
        Err(PlotError::Options("--points belong to --xy or --front"))
    } else if let Some(field) = &args.profile {
        draw_profile(args, field)
    } else {
        draw_snapshots(args)
    }
}

/// Draws sections, or views and radiographs where they are asked for.
fn draw_snapshots(args: &PlotArgs) -> Result<(), PlotError> {
    if let Some(along) = &args.scene.radiograph {
        return scene::draw_radiographs(args, along);
    }
    if let Some(from) = scene::view(args)? {
        return scene::draw_views(args, from);
    }
    let request = Request {
        field: args.field.clone(),
        section: args.section.clone(),
        drawn_as: args.drawn_as.clone(),
        thickness: args.thickness.clone(),
        mirror: !args.no_mirror,
        range: args.range.clone(),
        view: args.view.clone(),
    };
    let field = args.field.as_deref().unwrap_or("body");
    each::draw(args, field, |sources| {
        Pictures::new(&FileOpener, sources, &request)
    })
}

fn draw_profile(args: &PlotArgs, field: &str) -> Result<(), PlotError> {
    let request = ProfileRequest {
        field: field.to_owned(),
        along: Along::parse(&args.along)?,
        through: args.through.clone(),
        thickness: args.thickness.clone(),
        range: args.range.clone(),
        view: args.view.clone(),
        exact: args.exact,
    };
    let profiles = Profiles::new(&FileOpener, &sources(args)?, &request)?;
    let path = target(args, &format!("profile-{field}"));
    write_chart(profiles.chart(), args.width, &path)
}

/// The source, and what is drawn with it.
fn sources_of(args: &PlotArgs) -> impl Iterator<Item = &PathBuf> {
    [&args.source].into_iter().chain(&args.with)
}

/// The chosen snapshots of each place.
fn sources(args: &PlotArgs) -> Result<Vec<Source>, PlotError> {
    let source = |(name, path): (String, &PathBuf)| {
        Ok(Source {
            name,
            snapshots: args.which.at(path, default_choice(args))?,
        })
    };
    named_sources(args).into_iter().map(source).collect()
}

/// Each source with its name in a legend.
fn named_sources(args: &PlotArgs) -> Vec<(String, &PathBuf)> {
    let sources: Vec<&PathBuf> = sources_of(args).collect();
    names(&sources).into_iter().zip(sources).collect()
}

/// The names of runs or files in a legend: of those called alike those of their folders, as of `history.csv` of two
/// runs, else the paths as they were typed.
fn names(paths: &[&PathBuf]) -> Vec<String> {
    let own = |path: &&PathBuf| {
        let name = if path.is_dir() {
            path.file_name()
        } else {
            path.file_stem()
        };
        name.map(OsStr::to_owned)
    };
    let of_folder = |path: &&PathBuf| Some(path.parent()?.file_name()?.to_owned());
    let owns: Option<Vec<OsString>> = paths.iter().map(own).collect();
    let folders: Option<Vec<OsString>> = paths.iter().map(of_folder).collect();
    let different =
        |names: &Vec<OsString>| names.iter().collect::<BTreeSet<_>>().len() == names.len();
    let typed = || {
        paths
            .iter()
            .map(|path| path.as_os_str().to_owned())
            .collect()
    };
    let names = [owns, folders].into_iter().flatten().find(different);
    let names = names.unwrap_or_else(typed);
    names
        .iter()
        .map(|name| name.to_string_lossy().into_owned())
        .collect()
}

fn default_choice(args: &PlotArgs) -> Wanted {
    if args.movie.is_wanted() {
        Wanted::All
    } else if args.panels && args.with.is_empty() {
        Wanted::Three
    } else {
        Wanted::Last
    }
}

pub(super) fn wanted(args: &PlotArgs) -> Result<Wanted, PlotError> {
    args.which.wanted(default_choice(args))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_called_alike_are_told_apart() {
        let of = |paths: [&str; 2]| names(&[&PathBuf::from(paths[0]), &PathBuf::from(paths[1])]);
        assert_eq!(of(["a/b.csv", "c.csv"]), ["b", "c"]);
        assert_eq!(of(["runs/a/history.csv", "runs/b/history.csv"]), ["a", "b"]);
        let snapshots = ["a/snapshots/x.vtkhdf", "b/snapshots/x.vtkhdf"];
        assert_eq!(of(snapshots), snapshots);
    }
}
