//! Planes that open a model: what lies on the viewer's side of them is taken away.

use super::camera::Camera;
use crate::PlotError;
use crate::snapshots::plane::Plane;
use crate::snapshots::slice::position_text;
use crate::snapshots::snapshot::Snapshot;

/// A plane that is steeper to the picture than this takes nothing visible away.
const EDGE_ON: f64 = 1e-6;

/// The wedges that are taken away: all that lies on the viewer's side of each plane of one of them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cuts {
    wedges: Vec<Vec<Plane>>,
}

impl Cuts {
    /// Reads cuts, each of which names one or more planes as `y=0`, or `y` for the plane of symmetry
    /// or the middle; `none` is no cut.
    ///
    /// # Errors
    /// [`PlotError::Section`] for anything else, [`PlotError::Quantity`] for planes that the viewer
    /// looks along.
    pub fn parse(
        texts: &[String],
        camera: &Camera,
        snapshot: &Snapshot,
    ) -> Result<Self, PlotError> {
        let mut wedges = Vec::new();
        for text in texts.iter().filter(|text| text.trim() != "none") {
            let planes = text.split(',').map(|text| {
                let plane = Plane::parse(text.trim(), snapshot)?;
                if faces(camera, &plane) {
                    Ok(plane)
                } else {
                    Err(PlotError::quantity(
                        text,
                        format!(
                            "a plane with a side towards the viewer: the model is {}, along this one",
                            camera.name
                        ),
                    ))
                }
            });
            wedges.push(planes.collect::<Result<Vec<_>, _>>()?);
        }
        Ok(Self { wedges })
    }

    /// The wedge between the planes of symmetry that the viewer sees the sides of: a model that is
    /// drawn whole is opened there.
    pub fn open(camera: &Camera, snapshot: &Snapshot) -> Self {
        let planes = snapshot.symmetry.iter().map(|plane| Plane {
            axis: plane.axis,
            position: plane.position,
        });
        let wedge: Vec<Plane> = planes.filter(|plane| faces(camera, plane)).collect();
        Self {
            wedges: if wedge.is_empty() {
                Vec::new()
            } else {
                vec![wedge]
            },
        }
    }

    /// Each plane of each wedge as the distance towards the viewer over a place of the picture:
    /// `c + a x + b y` along the axes of [`Camera::project`] (m), and its normal in them.
    pub fn slopes(&self, camera: &Camera) -> Vec<Vec<Slope>> {
        let slope = |plane: &Plane| {
            let k = plane.axis.index();
            let (right, up, towards) = (camera.right[k], camera.up[k], camera.towards[k]);
            let sign = towards.signum();
            Slope {
                at_middle: plane.position / towards,
                along: [-right / towards, -up / towards],
                normal: [sign * right, sign * up, sign * towards],
            }
        };
        let wedges = self.wedges.iter();
        wedges
            .map(|wedge| wedge.iter().map(slope).collect())
            .collect()
    }

    /// `"cut open at x = 0 and y = 0"`; nothing if there is no cut.
    pub fn caption(&self, snapshot: &Snapshot) -> String {
        let plane =
            |plane: &Plane| position_text(plane.axis.name(), plane.position, snapshot.finest());
        let wedge = |wedge: &Vec<Plane>| wedge.iter().map(plane).collect::<Vec<_>>().join(" and ");
        match &self.wedges[..] {
            [] => String::new(),
            wedges => {
                let texts: Vec<String> = wedges.iter().map(wedge).collect();
                format!("cut open at {}", texts.join(", at "))
            }
        }
    }
}

/// A plane over the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope {
    /// Its distance towards the viewer over the origin of the picture's axes (m).
    pub at_middle: f64,
    /// Its change to the right and upwards.
    pub along: [f64; 2],
    /// Its normal towards the viewer, along the picture's axes.
    pub normal: [f64; 3],
}

/// `true` if a point along the picture's axes (m) is taken away.
pub fn takes(slopes: &[Vec<Slope>], at: &[f64; 3]) -> bool {
    let is_above = |slope: &Slope| {
        let [a, b] = slope.along;
        at[2] > slope.at_middle + a * at[0] + b * at[1]
    };
    slopes.iter().any(|wedge| wedge.iter().all(is_above))
}

fn faces(camera: &Camera, plane: &Plane) -> bool {
    camera.towards[plane.axis.index()].abs() > EDGE_ON
}
