//! `whipple plot --view isometric`: the whole model, seen from a side.

use super::out::named;
use super::{PlotArgs, curves, each};
use files::FileOpener;
use plot::{
    Camera, Format, NO_TABLE, PlotError, RadiographRequest, Radiographs, SceneRequest, Scenes,
};

/// What belongs to views and radiographs of whole models.
#[derive(Debug, Clone, Default, clap::Args)]
#[command(next_help_heading = "Views and radiographs of whole models")]
pub struct SceneArgs {
    /// The same as a name with --view, which then may say what part of the picture to draw
    #[arg(
        long,
        value_name = "NAME|AZIMUTH,ELEVATION",
        allow_hyphen_values = true
    )]
    pub from: Option<String>,

    /// Draw the mass per area along an axis, dark on light as a flash X-ray
    #[arg(long, value_name = "x|y|z", value_parser = ["x", "y", "z"], conflicts_with_all = ["from", "field"])]
    pub radiograph: Option<String>,

    /// Take away what lies on the viewer's side of a plane, or of all of some planes as in
    /// x=0,y=0; may be given several times [default: planes of symmetry that the model is
    /// reflected at; "none" leaves it whole]
    #[arg(long, value_name = "AXIS=POSITION", allow_hyphen_values = true)]
    pub cut: Vec<String>,

    /// Draw these bodies alone
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub bodies: Vec<String>,

    /// Bodies that let others be seen through them
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub transparent: Vec<String>,
}

/// From where the model is seen, if it is.
///
/// # Errors
/// [`PlotError::Options`] if two options say it.
pub fn view(args: &PlotArgs) -> Result<Option<&str>, PlotError> {
    let named = args.view.as_deref().filter(|text| Camera::is_view(text));
    match (named, args.scene.from.as_deref()) {
        (Some(_), Some(_)) => Err(PlotError::Options(
            "--view and --from both say from where: with --from give --view the part of the \
             picture, as in -1:1,0:2mm",
        )),
        (named, from) => Ok(named.or(from)),
    }
}

/// Refuses options that do not belong to what is drawn.
///
/// # Errors
/// [`PlotError::Options`] with what they belong to.
pub fn check(args: &PlotArgs) -> Result<(), PlotError> {
    let (own, radiograph) = (&args.scene, args.scene.radiograph.is_some());
    let asked = own.from.is_some() || radiograph || args.movie.is_wanted();
    let options = !own.cut.is_empty() || !own.transparent.is_empty() || !own.bodies.is_empty();
    if is_curve(args) {
        return complain_if(
            asked || options,
            "a view, radiograph or movie is a picture of snapshots: leave the other kind out",
        );
    }
    let from = view(args)?;
    let of_views = !own.cut.is_empty() || !own.transparent.is_empty();
    complain_if(
        from.is_none() && of_views,
        "--cut and --transparent belong to a view of the whole model: add --view isometric",
    )?;
    complain_if(
        from.is_some() && radiograph,
        "a radiograph has its own line of sight: --view may give the part of it, as in -1:1,0:2mm",
    )?;
    if from.is_none() && !radiograph {
        return complain_if(
            !own.bodies.is_empty(),
            "--bodies belongs to a view or a radiograph: add --view isometric",
        );
    }
    complain_if(args.csv || named(args) == Some(Format::Csv), NO_TABLE)?;
    complain_if(
        args.section.is_some() || args.drawn_as.is_some() || args.thickness.is_some(),
        "--section, --as and --thickness belong to sections: a view is opened by --cut",
    )
}

fn complain_if(wrong: bool, complaint: &'static str) -> Result<(), PlotError> {
    if wrong {
        Err(PlotError::Options(complaint))
    } else {
        Ok(())
    }
}

/// `true` if another sort of picture is asked for.
fn is_curve(args: &PlotArgs) -> bool {
    args.history.is_some()
        || args.fragments
        || args.distributions
        || args.front.is_some()
        || args.profile.is_some()
        || curves::is_table(args)
}

/// Draws views.
///
/// # Errors
/// [`PlotError`] if an input cannot be read, a request cannot be met or a picture not written.
pub fn draw_views(args: &PlotArgs, from: &str) -> Result<(), PlotError> {
    let request = SceneRequest {
        from: from.to_owned(),
        part: part(args),
        field: args.field.clone(),
        range: args.range.clone(),
        mirror: !args.no_mirror,
        cuts: args.scene.cut.clone(),
        bodies: args.scene.bodies.clone(),
        transparent: args.scene.transparent.clone(),
    };
    let field = args.field.as_deref().unwrap_or("body");
    let name = format!("{}-{field}", from.trim().replace(',', "_"));
    each::draw(args, &name, |sources| {
        Scenes::new(&FileOpener, sources, &request)
    })
}

/// Draws radiographs.
///
/// # Errors
/// [`PlotError`] if an input cannot be read, a request cannot be met or a picture not written.
pub fn draw_radiographs(args: &PlotArgs, along: &str) -> Result<(), PlotError> {
    let request = RadiographRequest {
        along: along.to_owned(),
        part: part(args),
        range: args.range.clone(),
        mirror: !args.no_mirror,
        bodies: args.scene.bodies.clone(),
    };
    let name = format!("radiograph-{along}");
    each::draw(args, &name, |sources| {
        Radiographs::new(&FileOpener, sources, &request)
    })
}

/// The part of the picture that is drawn.
fn part(args: &PlotArgs) -> Option<String> {
    args.view.clone().filter(|text| !Camera::is_view(text))
}
