//! Measures in `measures.csv`: plates, targets, bars, debris, regions and fronts.

use std::cell::OnceCell;

use toml::Spanned;

use super::defaults::{self, Strikers};
use super::loads::given_name;
use super::named::{body, fields, unique};
use super::region::region;
use super::shapes::vector;
use super::surfaces::unit_vector;
use crate::input::schema::{
    BarParams, DebrisParams, FrontParams, MeasureParams, NormalParams, SlabParams, ZoneParams,
};
use crate::input::source::Diagnostic;
use model::{
    Bar, Case, Debris, FrontLine, Include, Measure, MeasureKind, Slab, SphForm, Vec3, Zone,
    ZonePlace,
};

/// The outline of debris has this part of the areal mass of the plate that it left.
const OUTLINE: f64 = 0.02;

/// Without a plate it has this part of that of one layer of particles.
const OF_A_LAYER: f64 = 0.5;

/// Matter counts that is so many spacings from the line of a front.
const ASIDE: f64 = 1.5;

/// Pieces of a line of a front are so many spacings long.
const PIECE: f64 = 0.5;

/// Measures of a case: those that its tables name, and the default ones.
pub fn measures(case: &Case, params: &MeasureParams) -> Result<Vec<Measure>, Diagnostic> {
    let mut reader = Reader {
        case,
        strikers: OnceCell::new(),
        found: Vec::new(),
        marks: 0,
    };
    for table in &params.plate {
        reader.slab(table, MeasureKind::Plate, Include::Intact)?;
    }
    for table in &params.target {
        reader.slab(table, MeasureKind::Target, Include::All)?;
    }
    for table in &params.bar {
        reader.bar(table)?;
    }
    if params.usual() {
        reader.add_defaults();
    }
    for (n, table) in params.debris.iter().enumerate() {
        reader.debris(table, n + 1)?;
    }
    for (n, table) in params.region.iter().enumerate() {
        reader.zone(table, n + 1)?;
    }
    for (n, table) in params.front.iter().enumerate() {
        reader.front(table, n + 1)?;
    }
    if params.usual() {
        reader.usual_debris();
    }
    Ok(reader.found)
}

struct Reader<'a> {
    case: &'a Case,
    /// Known once a measure asks.
    strikers: OnceCell<Strikers<'a>>,
    found: Vec<Measure>,
    /// Regions that move with matter so far.
    marks: usize,
}

impl<'a> Reader<'a> {
    fn strikers(&self) -> &Strikers<'a> {
        self.strikers.get_or_init(|| Strikers::new(self.case))
    }

    fn add<T>(
        &mut self,
        table: &Spanned<T>,
        own: Option<&Spanned<String>>,
        name: String,
        kind: MeasureKind,
    ) -> Result<(), Diagnostic> {
        unique(self.has(&name), "measure", &name, own, table)?;
        self.found.push(Measure { name, kind });
        Ok(())
    }

    fn has(&self, name: &str) -> bool {
        self.found.iter().any(|other| other.name == name)
    }

    /// Only matter in space has holes and craters.
    fn require_space<T>(&self, table: &Spanned<T>) -> Result<(), Diagnostic> {
        if self.case.dimension == 3 {
            return Ok(());
        }
        Err(Diagnostic::new(
            table.span(),
            "this is measured in three dimensions alone",
        ))
    }

    /// The body that a measure of a shape is of.
    fn deforming(&self, name: &Spanned<String>) -> Result<usize, Diagnostic> {
        let index = body(self.case, name)?;
        if self.case.bodies[index].rigid.is_some() {
            let title = format!("the body `{}` is rigid", name.get_ref());
            return Err(Diagnostic::new(name.span(), title));
        }
        Ok(index)
    }

    /// A direction that is its own mirror image, or none of whose images is.
    fn direction(
        &self,
        key: &str,
        params: &Spanned<NormalParams>,
        may_cross: bool,
    ) -> Result<[f64; 3], Diagnostic> {
        let way = unit_vector(key, params, self.case.dimension)?;
        if defaults::suits_symmetry(self.case, &way, may_cross) {
            return Ok(way);
        }
        let title = "the direction is not its own mirror image at a symmetry plane";
        Err(Diagnostic::new(params.span(), title))
    }

    fn slab(
        &mut self,
        table: &Spanned<SlabParams>,
        kind: fn(Slab) -> MeasureKind,
        default: Include,
    ) -> Result<(), Diagnostic> {
        self.require_space(table)?;
        let params = table.get_ref();
        let index = self.deforming(&params.body)?;
        let normal = match &params.normal {
            Some(normal) => self.direction("normal", normal, false)?,
            None => defaults::struck_face(self.strikers(), index).ok_or_else(|| {
                let title = "nothing moves towards a face of the body that would be struck";
                Diagnostic::new(params.body.span(), title)
                    .help("give its `normal`, as in `normal = \"+z\"`")
            })?,
        };
        let name = self.name_or_body(params.name.as_ref(), index);
        let include = params.include.unwrap_or(default);
        let slab = Slab::new(self.case, index, normal, include);
        self.add(table, params.name.as_ref(), name, kind(slab))
    }

    fn name_or_body(&self, name: Option<&Spanned<String>>, body: usize) -> String {
        let own = || self.case.bodies[body].name.clone();
        name.map_or_else(own, |name| name.get_ref().clone())
    }

    fn bar(&mut self, table: &Spanned<BarParams>) -> Result<(), Diagnostic> {
        self.require_space(table)?;
        let params = table.get_ref();
        let index = self.deforming(&params.body)?;
        let foot = match &params.foot {
            Some(foot) => self.direction("foot", foot, true)?,
            None => defaults::foot(self.strikers(), index).ok_or_else(|| {
                let title = "the body has no axis of its own that would be a bar's";
                Diagnostic::new(params.body.span(), title)
                    .help("give its `foot`, as in `foot = \"-z\"`")
            })?,
        };
        let name = self.name_or_body(params.name.as_ref(), index);
        let kind = MeasureKind::Bar(Bar {
            body: index,
            foot,
            spacing: self.case.bodies[index].lattice.spacing,
        });
        self.add(table, params.name.as_ref(), name, kind)
    }

    /// The measures that shapes ask for, of bodies without one.
    fn add_defaults(&mut self) {
        if self.case.dimension < 3 {
            return;
        }
        for index in 0..self.case.bodies.len() {
            let measured = self.found.iter().any(|measure| match &measure.kind {
                MeasureKind::Plate(slab) | MeasureKind::Target(slab) => slab.body == index,
                MeasureKind::Bar(bar) => bar.body == index,
                _ => false,
            });
            let name = &self.case.bodies[index].name;
            if measured || self.has(name) {
                continue;
            }
            if let Some(kind) = defaults::measure(self.strikers(), index) {
                let name = name.clone();
                self.found.push(Measure { name, kind });
            }
        }
    }

    /// Adds the debris behind plates, and that before targets, unless a table names it.
    fn usual_debris(&mut self) {
        for k in 0..self.found.len() {
            let is_given = |measure: &Measure| matches!(&measure.kind, MeasureKind::Debris(d) if d.of == Some(k));
            if self.found.iter().any(is_given) {
                continue;
            }
            let (slab, what, sense) = match &self.found[k].kind {
                MeasureKind::Plate(slab) => (slab, "debris", -1.0),
                MeasureKind::Target(slab) => (slab, "ejecta", 1.0),
                _ => continue,
            };
            let direction = slab.normal.map(|n| sense * n + 0.0);
            let kind = MeasureKind::Debris(self.leaving(k, slab, direction));
            let name = format!("{}-{what}", self.found[k].name);
            if !self.has(&name) {
                self.found.push(Measure { name, kind });
            }
        }
    }

    /// Debris of a plate or target in a direction, as far as it struck it or is of it.
    fn leaving(&self, of: usize, slab: &Slab, direction: [f64; 3]) -> Debris {
        let rears = Vec3::from(slab.normal).dot(&Vec3::from(direction)) < 0.0;
        let height = if rears { slab.rear } else { slab.front };
        let bodies = slab.before.clone();
        let areal = if matches!(self.found[of].kind, MeasureKind::Plate(_)) {
            OUTLINE * slab.thickness()
        } else {
            OF_A_LAYER * slab.spacing
        };
        Debris {
            of: Some(of),
            point: slab.normal.map(|n| height * n),
            direction,
            outline: areal * self.case.density_of(slab.body),
            spacing: self.finest(&bodies),
            bodies,
        }
    }

    fn finest(&self, bodies: &[usize]) -> f64 {
        let all = bodies.iter().map(|&body| &self.case.bodies[body]);
        all.map(|body| body.lattice.spacing)
            .fold(f64::INFINITY, f64::min)
    }

    fn debris(&mut self, table: &Spanned<DebrisParams>, n: usize) -> Result<(), Diagnostic> {
        self.require_space(table)?;
        let params = table.get_ref();
        let direction = self.direction("direction", &params.direction, false)?;
        let mut debris = match &params.of {
            Some(name) => {
                let slab_of = |measure: &Measure| match &measure.kind {
                    MeasureKind::Plate(slab) | MeasureKind::Target(slab) => Some(slab.clone()),
                    _ => None,
                };
                let found = self.found.iter().enumerate();
                let mut slabs = found.filter_map(|(k, m)| Some((k, m, slab_of(m)?)));
                let same = slabs.find(|(_, measure, _)| measure.name == *name.get_ref());
                let Some((k, _, slab)) = same else {
                    let known = self.found.iter().filter(|m| slab_of(m).is_some());
                    let known = known.map(|measure| measure.name.as_str());
                    let what = "plate or target";
                    return Err(Diagnostic::unknown(
                        name.span(),
                        what,
                        name.get_ref(),
                        known,
                    ));
                };
                self.leaving(k, &slab, direction)
            }
            None => self.anything(direction),
        };
        if params.point.is_some() {
            debris.point = vector("point", params.point.as_ref(), 3)?;
        }
        if let Some(names) = &params.bodies {
            let all = names.get_ref().iter().map(|name| self.deforming(name));
            debris.bodies = all.collect::<Result<_, _>>()?;
            if debris.bodies.is_empty() {
                return Err(Diagnostic::new(names.span(), "the debris is of no body"));
            }
            debris.spacing = self.finest(&debris.bodies);
        }
        let outline = params.outline()?;
        debris.outline = outline.unwrap_or(debris.outline);
        let name = given_name(params.name.as_ref(), "debris", n);
        self.add(
            table,
            params.name.as_ref(),
            name,
            MeasureKind::Debris(debris),
        )
    }

    /// All matter that flies in a direction, beyond the origin.
    fn anything(&self, direction: [f64; 3]) -> Debris {
        let all = 0..self.case.bodies.len();
        let deforms = |&body: &usize| self.case.bodies[body].rigid.is_none();
        let bodies: Vec<usize> = all.filter(deforms).collect();
        let spacing = self.finest(&bodies);
        let densities = bodies.iter().map(|&body| self.case.density_of(body));
        let density = densities.fold(0.0, f64::max);
        Debris {
            of: None,
            point: [0.0; 3],
            direction,
            outline: OF_A_LAYER * spacing * density,
            spacing,
            bodies,
        }
    }

    fn refuse_stress_points<T>(&self, table: &Spanned<T>) -> Result<(), Diagnostic> {
        if self.case.sph.form != SphForm::StressPoints {
            return Ok(());
        }
        let title = "stress points cannot be read here";
        Err(Diagnostic::new(table.span(), title)
            .help("the other forms have their stress at the particles, see `sph.form`"))
    }

    fn zone(&mut self, table: &Spanned<ZoneParams>, n: usize) -> Result<(), Diagnostic> {
        self.refuse_stress_points(table)?;
        let params = table.get_ref();
        let sides = [params.above.as_ref(), params.below.as_ref()];
        let all: Vec<usize> = (0..self.case.bodies.len()).collect();
        let spacing = self.finest(&all);
        let place = match (params.radius()?, sides) {
            (Some(radius), [None, None]) => ZonePlace::Ball {
                centre: vector("centre", params.centre.as_ref(), self.case.dimension)?,
                radius,
            },
            (None, sides) if params.centre.is_none() => {
                ZonePlace::Sides(region(sides, self.case.dimension, spacing)?)
            }
            _ => {
                let title = "a region has sides, or a `centre` and a `radius`";
                let at = params.radius.as_ref().map_or(table.span(), Spanned::span);
                return Err(Diagnostic::new(at, title));
            }
        };
        let mark = params.moves().then_some(self.marks + 1);
        self.marks += usize::from(mark.is_some());
        if self.marks > ZonePlace::MOST {
            let title = format!("a case can have {} regions that move", ZonePlace::MOST);
            return Err(Diagnostic::new(table.span(), title));
        }
        let body = params.body.as_ref().map(|name| body(self.case, name));
        let kind = MeasureKind::Zone(Zone {
            place,
            mark: mark.and_then(|mark| u32::try_from(mark).ok()),
            body: body.transpose()?,
            fields: fields(params.fields.as_ref(), true)?,
        });
        let name = given_name(params.name.as_ref(), "region", n);
        self.add(table, params.name.as_ref(), name, kind)
    }

    fn front(&mut self, table: &Spanned<FrontParams>, n: usize) -> Result<(), Diagnostic> {
        self.refuse_stress_points(table)?;
        let params = table.get_ref();
        let from = vector("from", Some(&params.from), self.case.dimension)?;
        let to = vector("to", Some(&params.to), self.case.dimension)?;
        if from == to {
            let title = "the line ends where it begins";
            return Err(Diagnostic::new(params.to.span(), title));
        }
        let all: Vec<usize> = (0..self.case.bodies.len()).collect();
        let spacing = self.finest(&all);
        let kind = MeasureKind::Front(FrontLine {
            from,
            to,
            radius: params.radius()?.unwrap_or(ASIDE * spacing),
            piece: PIECE * spacing,
            pressure: params.pressure()?,
        });
        let name = given_name(params.name.as_ref(), "front", n);
        self.add(table, params.name.as_ref(), name, kind)
    }
}
