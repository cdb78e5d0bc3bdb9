//! Newtonian viscosity, `S = 2 η dev D` with `D = sym L`.
//!
//! L is that of the middle of the step, so that the stress lags half a step behind.

use super::{Conditions, LANES, Law, PointBatch};

law! {
    /// A Newtonian fluid.
    Viscous {
        /// Dynamic viscosity η (Pa s).
        viscosity: "Pa s",
    }
}

impl Law for Viscous {
    const STATE: &'static [&'static str] = &["deviatoric_stress"];

    fn viscosity(&self) -> f64 {
        self.viscosity
    }

    /// Sets the stress, which is no state: also with a step of zero.
    #[inline(always)]
    fn deform(&self, point: &mut PointBatch, _now: &mut Conditions) {
        let two_eta = 2.0 * self.viscosity;
        let [xx, xy, xz, yx, yy, yz, zx, zy, zz] = &point.velocity_gradient;
        let s = &mut point.deviatoric_stress;
        for k in 0..LANES {
            let third = (xx[k] + yy[k] + zz[k]) * (1.0 / 3.0);
            s[0][k] = two_eta * (xx[k] - third);
            s[1][k] = two_eta * (yy[k] - third);
            s[2][k] = two_eta * (zz[k] - third);
            s[3][k] = self.viscosity * (xy[k] + yx[k]);
            s[4][k] = self.viscosity * (xz[k] + zx[k]);
            s[5][k] = self.viscosity * (yz[k] + zy[k]);
        }
    }
}
