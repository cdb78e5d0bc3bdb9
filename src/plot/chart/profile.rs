//! Values of particles along a line, or over the distance from a point.

use std::path::Path;

use super::curves::{Chart, Curve, Quantity};
use super::exact::{self, Exact};
use crate::PlotError;
use crate::canvas::INK;
use crate::colour;
use crate::header::Mark;
use crate::snapshots::field::{Drawn, Field};
use crate::snapshots::plane::Plane;
use crate::snapshots::slice::{self, slice};
use crate::snapshots::snapshot::Snapshot;
use crate::snapshots::source::Source;
use crate::units;
use model::Axis;
use results::Opener;

/// About how many of many curves have a name in the legend.
const NAMED: usize = 10;

/// The coordinate of a profile.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// A line parallel to an axis.
    Line(Axis),
    /// The distance from a point.
    Radius,
}

impl Along {
    /// Reads `x`, `y`, `z` or `r`.
    ///
    /// # Errors
    /// [`PlotError::Quantity`] for anything else.
    pub fn parse(text: &str) -> Result<Self, PlotError> {
        let axis = Axis::named(text);
        match axis {
            Some(axis) => Ok(Self::Line(axis)),
            None if text == "r" => Ok(Self::Radius),
            None => Err(PlotError::quantity(
                text,
                "x, y, z, or r for the distance from a point",
            )),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Line(axis) => axis.name(),
            Self::Radius => "r",
        }
    }
}

/// A request for a profile, as typed.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileRequest {
    /// A field, `FIELD.COMPONENT` or `von_mises`.
    pub field: String,
    /// The coordinate of the profile.
    pub along: Along,
    /// Positions of the line on the other axes, `AXIS=POSITION,…`, or the point; by default planes
    /// of symmetry or the middle of the model.
    pub through: Option<String>,
    /// Thickness of the line; the rows beside it if absent.
    pub thickness: Option<String>,
    /// `LOW:HIGH` of the field; all values if absent.
    pub range: Option<String>,
    /// `LOW:HIGH` of the coordinate; all particles if absent.
    pub view: Option<String>,
    /// `true` if the exact answer is drawn with it.
    pub exact: bool,
}

/// Profiles of one field of some snapshots of some runs.
#[derive(Debug)]
pub struct Profiles {
    chart: Chart,
}

/// The line of a profile.
struct Line {
    along: Along,
    through: [f64; 3],
    thickness: Option<f64>,
}

/// The profile of one snapshot.
struct Taken {
    name: String,
    time: f64,
    bodies: Vec<String>,
    /// Body, coordinate and value of each particle.
    dots: Vec<(usize, f64, f64)>,
}

impl Profiles {
    /// Takes the profiles of some runs; the first snapshot decides line and titles, the first
    /// run has the exact answer.
    ///
    /// # Errors
    /// Any [`PlotError`] but those of writing.
    pub fn new(
        opener: &dyn Opener,
        sources: &[Source],
        request: &ProfileRequest,
    ) -> Result<Self, PlotError> {
        let path = sources.iter().find_map(|source| source.snapshots.first());
        let path = path.ok_or(PlotError::Options("no snapshot to draw"))?;
        let first = Snapshot::open(opener, path)?;
        let Drawn::Field(field) = Drawn::find(&first, &request.field)? else {
            return Err(PlotError::Options(
                "a profile shows a field, as in --profile pressure",
            ));
        };
        let line = Line::new(request, &first)?;
        let mut taken = Vec::new();
        for source in sources {
            for path in &source.snapshots {
                taken.push(line.take(
                    &Snapshot::open(opener, path)?,
                    &request.field,
                    &source.name,
                )?);
            }
        }
        if taken.iter().all(|profile| profile.dots.is_empty()) {
            return Err(PlotError::Line {
                line: line.text(&first),
            });
        }
        let mut chart = Chart {
            title: first.title.clone(),
            subtitle: subtitle(&line, &first, &taken),
            x: Quantity {
                label: line.along.name().to_owned(),
                unit: "m".to_owned(),
                span: span(request.view.as_deref(), "m")?,
                room: true,
                ..Quantity::default()
            },
            y: axis_of(&field, span(request.range.as_deref(), &field.unit)?),
            curves: curves(&taken, sources.len()),
        };
        if request.exact {
            let count = sources[0].snapshots.len();
            chart
                .curves
                .extend(exact_curves(opener, path, request, &taken[..count])?);
        }
        Ok(Self { chart })
    }

    /// The chart.
    #[must_use]
    pub fn chart(&self) -> &Chart {
        &self.chart
    }
}

impl Line {
    fn new(request: &ProfileRequest, snapshot: &Snapshot) -> Result<Self, PlotError> {
        let extent = snapshot.extent()?;
        let mut through = Axis::ALL.map(|axis| Plane::through(axis, snapshot, &extent).position);
        let typed = request.through.iter().flat_map(|text| text.split(','));
        for text in typed {
            let plane = Plane::parse(text, snapshot)?;
            through[plane.axis.index()] = plane.position;
        }
        Ok(Self {
            along: request.along,
            through,
            thickness: request
                .thickness
                .as_deref()
                .map(slice::thickness)
                .transpose()?,
        })
    }

    /// The particles of a line: within half a thickness along each other axis.
    fn take(&self, snapshot: &Snapshot, field: &str, name: &str) -> Result<Taken, PlotError> {
        let drawn = Drawn::find(snapshot, field)?;
        let mut dots = Vec::new();
        for rows in snapshot.chunks() {
            let points = snapshot.file.points(rows.clone())?;
            let bodies = snapshot.body_of(rows.clone())?;
            let values = drawn.values(snapshot, rows.clone())?;
            let bearers = drawn.bearers(snapshot, rows)?;
            let all = points.into_iter().zip(bodies).zip(values).zip(bearers);
            for (((point, body), value), _) in all.filter(|(_, bears)| *bears) {
                if let Some(at) = self.coordinate(&point, snapshot, body) {
                    dots.push((body, at, value));
                }
            }
        }
        dots.sort_by(|a, b| a.1.total_cmp(&b.1));
        Ok(Taken {
            name: name.to_owned(),
            time: snapshot.time,
            bodies: snapshot.bodies.clone(),
            dots,
        })
    }

    /// The coordinate of a particle on the line, if it is on it.
    fn coordinate(&self, point: &[f64; 3], snapshot: &Snapshot, body: usize) -> Option<f64> {
        let from = |axis: Axis| point[axis.index()] - self.through[axis.index()];
        let along = match self.along {
            Along::Radius => {
                return Some(
                    Axis::ALL
                        .map(|a| from(a) * from(a))
                        .iter()
                        .sum::<f64>()
                        .sqrt(),
                );
            }
            Along::Line(axis) => axis,
        };
        let spacing = snapshot.spacings[body];
        let on_line = |axis: &Axis| {
            let on_mirror = snapshot
                .symmetry
                .iter()
                .any(|plane| plane.axis == *axis && plane.position == self.through[axis.index()]);
            // One row, or the two on either side of the line; on a symmetry plane the row next
            // to it. Rows may drift by a quarter of a spacing, or half a one, before they go.
            let default = if on_mirror {
                2.0 * spacing
            } else {
                1.5 * spacing
            };
            let half = 0.5 * self.thickness.unwrap_or(default);
            slice(from(*axis), half, spacing)
        };
        let others = Axis::ALL.iter().filter(|axis| **axis != along);
        others
            .into_iter()
            .all(on_line)
            .then(|| point[along.index()])
    }

    /// `"through y = 0, z = 0"` for the axes in which the model has an extent.
    fn text(&self, snapshot: &Snapshot) -> String {
        let extent = snapshot.extent().unwrap_or_default();
        let thick = |axis: &&Axis| {
            let reach = &extent[axis.index()];
            Along::Line(**axis) != self.along && reach.highest - reach.lowest > 0.0
        };
        let position_text = |axis: &Axis| {
            let position = self.through[axis.index()];
            slice::position_text(axis.name(), position, snapshot.finest())
        };
        let crossings: Vec<String> = Axis::ALL.iter().filter(thick).map(position_text).collect();
        let along = match self.along {
            Along::Line(axis) => format!("along {}", axis.name()),
            Along::Radius => "over the distance r from a point".to_owned(),
        };
        match (&crossings[..], self.along) {
            ([], _) => along,
            (_, Along::Line(_)) => format!("{along} through {}", crossings.join(", ")),
            (_, Along::Radius) => format!("{along}, {}", crossings.join(", ")),
        }
    }
}

fn span(text: Option<&str>, unit: &str) -> Result<Option<[f64; 2]>, PlotError> {
    text.map(|text| units::parse_span(text, None, unit))
        .transpose()
}

fn axis_of(field: &Field, span: Option<[f64; 2]>) -> Quantity {
    Quantity {
        label: field.label.clone(),
        unit: field.unit.clone(),
        span,
        room: true,
        ..Quantity::default()
    }
}

fn subtitle(line: &Line, snapshot: &Snapshot, taken: &[Taken]) -> String {
    let at = line.text(snapshot);
    match units::times(&taken.iter().map(|t| t.time).collect::<Vec<_>>()) {
        times if times.windows(2).all(|pair| pair[0] == pair[1]) => {
            format!("t = {},  {at}", times[0])
        }
        _ => at,
    }
}

/// A curve for each body of a single profile, else one for each profile.
fn curves(taken: &[Taken], sources: usize) -> Vec<Curve> {
    let dots = |name: String, colour, points| Curve {
        name,
        colour,
        mark: Mark::Dots,
        points,
        ..Curve::default()
    };
    if let [only] = taken {
        let of = |body: usize| {
            let dots = only.dots.iter().filter(move |dot| dot.0 == body);
            dots.map(|dot| [dot.1, dot.2]).collect()
        };
        let bodies = only.bodies.iter().enumerate();
        return bodies
            .map(|(k, name)| dots(name.clone(), colour::body(k), of(k)))
            .collect();
    }
    let times = units::times(&taken.iter().map(|t| t.time).collect::<Vec<_>>());
    let same_time = times.windows(2).all(|pair| pair[0] == pair[1]);
    // Of many times some are named.
    let every = taken.len().div_ceil(NAMED);
    let curve = |(k, profile): (usize, &Taken)| {
        let name = match (sources > 1, same_time) {
            (true, true) => profile.name.clone(),
            (true, false) => format!("{}, {}", profile.name, times[k]),
            (false, _) => times[k].clone(),
        };
        let is_named = k.is_multiple_of(every) || k + 1 == taken.len();
        let points = profile.dots.iter().map(|dot| [dot.1, dot.2]).collect();
        Curve {
            in_tables: name.clone(),
            ..dots(
                if is_named { name } else { String::new() },
                colour::series(k, taken.len()),
                points,
            )
        }
    };
    taken.iter().enumerate().map(curve).collect()
}

/// The exact answer at the times of some profiles: of several, each in a darker shade of its
/// profile.
fn exact_curves(
    opener: &dyn Opener,
    path: &Path,
    request: &ProfileRequest,
    taken: &[Taken],
) -> Result<Vec<Curve>, PlotError> {
    let answer = Exact::of_run(opener, path)?;
    let mut curves = Vec::new();
    let times = units::times(&taken.iter().map(|t| t.time).collect::<Vec<_>>());
    for (k, profile) in taken.iter().enumerate() {
        let shade = colour::series(k, taken.len()).map(|c| c / 2);
        curves.push(Curve {
            in_tables: format!("exact, {}", times[k]),
            colour: if taken.len() == 1 { INK } else { shade },
            mark: Mark::Thin,
            points: exact_points(&answer, request, profile.time)?,
            ..Curve::default()
        });
    }
    // For the legend alone.
    curves.push(Curve {
        name: "exact".to_owned(),
        colour: INK,
        mark: Mark::Thin,
        points: Vec::new(),
        ..Curve::default()
    });
    Ok(curves)
}

/// The answer at a time, with a break between any two connected stretches.
fn exact_points(
    answer: &Exact,
    request: &ProfileRequest,
    time: f64,
) -> Result<Vec<[f64; 2]>, PlotError> {
    let unknown = || PlotError::Exact {
        reason: format!(
            "the answer is known along x for {}, not for {} along {}",
            exact::FIELDS.join(", "),
            request.field,
            request.along.name()
        ),
    };
    if request.along != Along::Line(Axis::X) {
        return Err(unknown());
    }
    let mut points = Vec::new();
    for line in answer.profile(time)? {
        for sample in &line {
            let value = exact::value(&request.field, sample).ok_or_else(unknown)?;
            points.push([sample.position, value]);
        }
        points.push([f64::NAN; 2]);
    }
    Ok(points)
}
