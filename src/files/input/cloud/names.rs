//! Names in files of the quantities that they hold.

use model::Quantity;

/// Components in the order in which VTK has those of symmetric tensors, as ours.
const VTK_ORDER: [usize; 6] = [0, 1, 2, 3, 5, 4];

/// Names of a quantity as one array.
pub fn of_array(quantity: Quantity) -> &'static [&'static str] {
    match quantity {
        Quantity::Position => &["position", "positions", "Points", "points", "coordinates"],
        Quantity::Mass => &["mass", "masses", "Mass"],
        Quantity::Volume => &["volume", "volumes", "Volume"],
        Quantity::Density => &["density", "Density", "rho"],
        Quantity::Velocity => &["velocity", "velocities", "Velocity", "v"],
        Quantity::SpecificEnergy => &["specific_energy"],
        Quantity::Temperature => &["temperature", "Temperature"],
        Quantity::DeviatoricStress => &["deviatoric_stress"],
        Quantity::PlasticStrain => &["plastic_strain"],
        Quantity::Damage => &["damage"],
        Quantity::FailureEnergy => &["failure_energy"],
        Quantity::Compaction => &["compaction"],
        Quantity::Burn => &["burn"],
        Quantity::HourglassDisplacement => &["hourglass_displacement"],
    }
}

/// Names of a component of a quantity as a column; those of a whole that is called `base`.
pub fn of_column(quantity: Quantity, component: usize, base: Option<&str>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let axes = ["x", "y", "z"];
    let bases = base.map_or_else(|| of_array(quantity).to_vec(), |base| vec![base]);
    match quantity.components() {
        1 => return bases.iter().map(|name| (*name).to_owned()).collect(),
        3 => {
            let axis = axes[component];
            if base.is_none() && quantity == Quantity::Position {
                names.push(axis.to_owned());
            }
            if base.is_none() && quantity == Quantity::Velocity {
                names.push(format!("v{axis}"));
            }
            for base in bases {
                let ends = [
                    format!("_{axis}"),
                    format!(":{component}"),
                    format!("_{component}"),
                ];
                names.extend(ends.map(|end| format!("{base}{end}")));
            }
        }
        _ => {
            let pair = ["xx", "yy", "zz", "xy", "xz", "yz"][component];
            let place = VTK_ORDER[component];
            for base in bases {
                names.extend([format!("{base}_{pair}"), format!("{base}:{place}")]);
            }
        }
    }
    names
}

/// Components of rows that VTK has written, in our order.
pub fn from_vtk(quantity: Quantity, values: &mut [f64]) {
    if quantity == Quantity::DeviatoricStress {
        for row in values.chunks_exact_mut(6) {
            row.swap(4, 5);
        }
    }
}
