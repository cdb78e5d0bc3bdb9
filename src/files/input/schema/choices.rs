//! Words to choose from that make no choice of the model by themselves; those that do are read as
//! it.

use serde::Deserialize;

use super::describe::described_words;

choices! {
    /// Choice of the program.
    AutoWord {
        /// Whatever is best.
        Auto,
    }
    /// Lattices on which a shape is repeated.
    RepeatName {
        /// Points of a line.
        Line,
        /// Squares of a plane.
        Square,
        /// Triangles of a plane, whose cells are hexagons.
        Hexagonal,
        /// Cubes.
        Cubic,
    }
    /// Side of a surface.
    SideName {
        /// Outside, as of a punch.
        Outside,
        /// Inside, as of a container.
        Inside,
    }
    /// Smoothing length in the SPH sums.
    SmoothingName {
        /// h = h₀.
        Constant,
        /// h follows the density.
        Variable,
    }
    /// Format of a file of particles.
    FormatName {
        /// Comma-separated values.
        Csv,
        /// A snapshot of this program.
        Snapshot,
        /// Arrays of any HDF5 file.
        Hdf5,
        /// VTK's XML: unstructured grids and points.
        Vtu,
        /// LS-DYNA keywords.
        Dyna,
        /// Abaqus keywords.
        Abaqus,
        /// Gmsh meshes.
        Gmsh,
        /// LAMMPS dumps.
        Lammps,
        /// Extended XYZ.
        Xyz,
    }
    /// Parts of a mesh that become particles.
    TakeName {
        /// Middles of elements, each with its volume.
        Elements,
        /// Nodes, each with its share of the elements around it.
        Nodes,
    }
}

/// A signed axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub enum Direction {
    /// Towards larger x.
    #[serde(rename = "+x")]
    PlusX,
    /// Towards smaller x.
    #[serde(rename = "-x")]
    MinusX,
    /// Towards larger y.
    #[serde(rename = "+y")]
    PlusY,
    /// Towards smaller y.
    #[serde(rename = "-y")]
    MinusY,
    /// Towards larger z.
    #[serde(rename = "+z")]
    PlusZ,
    /// Towards smaller z.
    #[serde(rename = "-z")]
    MinusZ,
}

/// An axis with its sense, the positive one if none is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub enum AxisWord {
    /// Towards larger x.
    #[serde(rename = "x", alias = "+x")]
    PlusX,
    /// Towards smaller x.
    #[serde(rename = "-x")]
    MinusX,
    /// Towards larger y.
    #[serde(rename = "y", alias = "+y")]
    PlusY,
    /// Towards smaller y.
    #[serde(rename = "-y")]
    MinusY,
    /// Towards larger z.
    #[serde(rename = "z", alias = "+z")]
    PlusZ,
    /// Towards smaller z.
    #[serde(rename = "-z")]
    MinusZ,
}

described_words!(Direction, AxisWord);

impl AxisWord {
    /// Number of the axis (0, 1, 2), and 1 or −1.
    #[must_use]
    pub fn sense(self) -> (usize, f64) {
        match self {
            Self::PlusX => (0, 1.0),
            Self::MinusX => (0, -1.0),
            Self::PlusY => (1, 1.0),
            Self::MinusY => (1, -1.0),
            Self::PlusZ => (2, 1.0),
            Self::MinusZ => (2, -1.0),
        }
    }
}
