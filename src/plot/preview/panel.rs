//! A panel: what part of space it shows, from where, and how many pixels of it.

use crate::axes::Axes;
use crate::canvas::Frame;
use crate::picture::view::View;
use crate::snapshots::plane::Plane;
use model::Axis;

/// A view along an axis.
#[derive(Debug, Clone, Copy)]
pub struct Panel {
    /// The axis that is looked along, and where a section is.
    pub plane: Plane,
    /// The visible part of the other two (m).
    pub view: View,
    /// Its frame in the picture (whole pixels).
    pub frame: Frame,
}

impl Panel {
    /// The axes that point right and up: 0, 1 or 2.
    pub fn axes(&self) -> [usize; 2] {
        self.plane.picture_axes().map(Axis::index)
    }

    /// The direction to the viewer along the normal: 1 for growing coordinates, else −1. The three
    /// axes are right-handed, right and up those of the picture.
    pub fn towards(&self) -> f64 {
        if self.plane.axis == Axis::Y {
            -1.0
        } else {
            1.0
        }
    }

    /// The pixel of a place (m).
    pub fn at(&self, point: &[f64; 3]) -> (f32, f32) {
        let [right, up] = self.axes();
        let axes = Axes {
            frame: self.frame,
            x: self.view.x,
            y: self.view.y,
        };
        axes.at(point[right], point[up])
    }

    /// The place (m) of a pixel of the frame, counted from its upper left corner, at a coordinate
    /// (m) along the normal.
    pub fn point(&self, x: f64, y: f64, along: f64) -> [f64; 3] {
        let [right, up] = self.axes();
        let mut point = [0.0; 3];
        point[self.plane.axis.index()] = along;
        point[right] = self.view.x[0] + x / self.scale();
        point[up] = self.view.y[1] - y / self.scale();
        point
    }

    /// Pixels in a metre.
    pub fn scale(&self) -> f64 {
        f64::from(self.frame.width) / self.view.width()
    }

    /// The view of a box (m) along an axis.
    pub fn view_of(axis: Axis, (lower, upper): &([f64; 3], [f64; 3])) -> View {
        let plane = Plane {
            axis,
            position: 0.0,
        };
        let [right, up] = plane.picture_axes().map(Axis::index);
        View {
            x: [lower[right], upper[right]],
            y: [lower[up], upper[up]],
        }
    }
}
