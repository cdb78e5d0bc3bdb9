//! `whipple plot`: pictures from a snapshot or a run folder.

use std::path::{Path, PathBuf};

use crate::plot::{
    Canvas, History, Pictures, PlotError, Request, Wanted, choose, parse_quantity, snapshots, title,
};

/// Draw sections of snapshots, or the energies of a run, as PNG pictures
///
/// Particles of one layer about a plane are drawn to scale as discs of the particle spacing,
/// coloured by body or by a field. A run's last snapshot is drawn unless others are asked for.
#[derive(Debug, Clone, clap::Args)]
#[command(after_help = "Examples:
  whipple plot runs/impact                                   last snapshot, by body
  whipple plot runs/impact --field pressure --time 0.1us
  whipple plot runs/impact --panels --time 0us,0.1us,0.2us   side by side
  whipple plot runs/impact --all --field velocity.z --range -7:1km/s
  whipple plot state.vtkhdf --section z=0.1mm --view -1:1,-1:1mm
  whipple plot runs/impact --history")]
#[expect(
    clippy::struct_excessive_bools,
    clippy::doc_markdown,
    reason = "each is a switch of the command line; the comments are its help"
)]
pub struct PlotArgs {
    /// Snapshot file (.vtkhdf) or run folder
    #[arg(value_name = "FILE_OR_RUN")]
    pub source: PathBuf,

    /// Picture to write if the name ends in .png, else the folder to write into [default: beside
    /// the snapshot, or RUN/pictures]
    #[arg(short, long, value_name = "PNG_OR_FOLDER")]
    pub out: Option<PathBuf>,

    /// What colours show: "body", a field, FIELD.COMPONENT (x, y, z, magnitude; xx … xz,
    /// von_mises) or "von_mises" [default: body]
    #[arg(short, long, value_name = "NAME")]
    pub field: Option<String>,

    /// Plane of the section, as in y=0.1mm; with the axis alone its plane of symmetry or the
    /// middle [default: z of a flat model, else a plane of symmetry, else the middle of y]
    #[arg(short, long, value_name = "AXIS=POSITION")]
    pub section: Option<String>,

    /// Thickness of the slice about the plane, as in 0.1mm [default: one particle spacing, two on a
    /// plane of symmetry: one layer of a cubic lattice]
    #[arg(long, value_name = "LENGTH")]
    pub thickness: Option<String>,

    /// Reflect the model at its planes of symmetry (this is the default)
    #[arg(long, overrides_with = "no_mirror")]
    pub mirror: bool,

    /// Show only the part that was computed
    #[arg(long)]
    pub no_mirror: bool,

    /// Values at the ends of the colour bar, as in 0:100GPa [default: all values but a few
    /// outliers]
    #[arg(long, value_name = "LOW:HIGH", allow_hyphen_values = true)]
    pub range: Option<String>,

    /// Part of the plane to draw, as in -1:1,0:2mm [default: all particles]
    #[arg(long, value_name = "LEFT:RIGHT,BOTTOM:TOP", allow_hyphen_values = true)]
    pub view: Option<String>,

    /// Width of the picture in pixels [default: 1200, panels 1800]
    #[arg(long, value_name = "PX", value_parser = clap::value_parser!(u32).range(400..=20_000))]
    pub width: Option<u32>,

    /// Snapshots of the run nearest to these times, as in 0.1us
    #[arg(long, value_name = "TIME", value_delimiter = ',', group = "which")]
    pub time: Vec<String>,

    /// Snapshots of the run by number, from 0
    #[arg(long, value_name = "K", value_delimiter = ',', group = "which")]
    pub index: Vec<usize>,

    /// All snapshots of the run, with one view and one range of colours
    #[arg(long, group = "which")]
    pub all: bool,

    /// Draw the snapshots side by side in one picture [default: the first, middle and last]
    #[arg(long)]
    pub panels: bool,

    /// Draw the run's energies against time instead
    #[arg(long, conflicts_with_all = [
        "which", "field", "section", "thickness", "no_mirror", "panels", "range", "view",
    ])]
    pub history: bool,
}

/// Makes the pictures and prints their paths.
///
/// # Errors
/// [`PlotError`] if an input cannot be read, a request cannot be met or a picture not written.
pub fn run(args: &PlotArgs) -> Result<(), PlotError> {
    if args.history {
        return draw_history(args);
    }
    let paths = if args.source.is_dir() {
        choose(&snapshots(&args.source)?, &wanted(args)?)?
    } else if args.all || !args.time.is_empty() || !args.index.is_empty() {
        return Err(PlotError::Options(
            "--time, --index and --all choose among the snapshots of a run: give its folder",
        ));
    } else {
        vec![args.source.clone()]
    };
    let request = Request {
        field: args.field.clone(),
        section: args.section.clone(),
        thickness: args.thickness.clone(),
        mirror: !args.no_mirror,
        range: args.range.clone(),
        view: args.view.clone(),
    };
    let pictures = Pictures::new(&paths, &request)?;
    let field = args.field.as_deref().unwrap_or("body");
    if args.panels {
        let canvas = pictures.panels(args.width)?;
        return write(&canvas, &target(args, &format!("panels-{field}.png")));
    }
    let named = args.out.as_deref().is_some_and(is_png);
    if named && paths.len() > 1 {
        return Err(PlotError::Options(
            "several pictures cannot have one name: give --out a folder, or add --panels",
        ));
    }
    for (k, path) in paths.iter().enumerate() {
        let canvas = pictures.single(k, args.width)?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        write(&canvas, &target(args, &format!("{stem}-{field}.png")))?;
    }
    Ok(())
}

fn draw_history(args: &PlotArgs) -> Result<(), PlotError> {
    let run = args.source.is_dir();
    let file = if run {
        args.source.join("history.csv")
    } else {
        args.source.clone()
    };
    let history = History::read(&file)?;
    // The snapshots know the title; a run without any is called by its folder.
    let known = snapshots(&args.source).and_then(|found| title(&found[0].1));
    let place = if run { &args.source } else { &file };
    let title = known.unwrap_or_else(|_| place.display().to_string());
    let canvas = history.draw(&title, args.width)?;
    write(&canvas, &target(args, "history.png"))
}

fn wanted(args: &PlotArgs) -> Result<Wanted, PlotError> {
    if args.all {
        Ok(Wanted::All)
    } else if !args.time.is_empty() {
        let times = args.time.iter().map(|text| parse_quantity(text, "s"));
        Ok(Wanted::Times(times.collect::<Result<_, _>>()?))
    } else if !args.index.is_empty() {
        Ok(Wanted::Indices(args.index.clone()))
    } else if args.panels {
        Ok(Wanted::Three)
    } else {
        Ok(Wanted::Last)
    }
}

/// The path of a picture that is called `name` unless `--out` calls it otherwise.
fn target(args: &PlotArgs, name: &str) -> PathBuf {
    match &args.out {
        Some(out) if is_png(out) => out.clone(),
        Some(out) => out.join(name),
        None if args.source.is_dir() => args.source.join("pictures").join(name),
        None => args.source.with_file_name(name),
    }
}

fn is_png(path: &Path) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("png"))
}

fn write(canvas: &Canvas, path: &Path) -> Result<(), PlotError> {
    if let Some(folder) = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
    {
        std::fs::create_dir_all(folder).map_err(|e| PlotError::Save {
            path: path.to_owned(),
            reason: e.to_string(),
        })?;
    }
    canvas.save(path)?;
    println!("wrote {}", path.display());
    Ok(())
}
