//! What one contact constraint does in an increment.
//!
//! A row has a curve (a softened law, a penalty), a wall (hard contact), a dashpot (contact damping), or several of them:
//!
//! ```text
//! no wall     F = A (p(h) + mu(h) (h − h_start) / Δt)
//! one-sided   the same below the wall at h = position; any larger force on it
//! two-sided   h = position, any force
//! ```
//!
//! Rows of the normal direction measure overclosures, tangential rows relative displacements along a tangent.

use crate::law::{Damping, LawPoint, NormalBehavior, Penalty, PressureLaw};

/// Slope of a dashpot, relative to what it would be at a constant coefficient, below which that is taken instead: a dashpot that
/// lets go has a falling force.
const SLOPE_MIN: f64 = 0.25;

/// A place that the overclosure does not pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wall {
    /// There is none.
    #[default]
    None,
    /// It may go back.
    OneSided,
    /// It stays there.
    TwoSided,
}

/// Pressure over overclosure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Curve {
    /// None.
    #[default]
    None,
    /// Law of a behaviour, by its index.
    Law(u32),
    /// A penalty.
    Penalty(Penalty),
}

/// Coefficient of a dashpot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viscosity {
    /// By the clearance, the sum of two.
    Ramps([Damping; 2]),
    /// The same everywhere \[pressure·time/length\].
    Constant(f64),
}

/// `mu (h − start) rate`: backward Euler over the increment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dashpot {
    /// `mu`.
    pub viscosity: Viscosity,
    /// Overclosure at the start of the increment \[length\].
    pub start: f64,
    /// `1 / Δt` [1/time].
    pub rate: f64,
}

/// A constraint with its area.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Row {
    /// Tributary area \[length²\].
    pub area: f64,
    /// Wall.
    pub wall: Wall,
    /// Overclosure of the wall \[length\].
    pub position: f64,
    /// Curve.
    pub curve: Curve,
    /// Dashpot.
    pub dashpot: Option<Dashpot>,
}

/// Force of a row and its slope.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RowPoint {
    /// Force \[force\].
    pub force: f64,
    /// Slope for a Newton step [force/length]: not negative; the true one except where a dashpot lets go.
    pub stiffness: f64,
}

impl Dashpot {
    /// Viscous pressure and its slope for a Newton step.
    fn evaluate(&self, overclosure: f64) -> (f64, f64) {
        let (mu, slope) = match self.viscosity {
            Viscosity::Ramps([first, second]) => {
                let ((a, da), (b, db)) = (first.at(overclosure), second.at(overclosure));
                (a + b, da + db)
            }
            Viscosity::Constant(mu) => (mu, 0.0),
        };
        let speed = (overclosure - self.start) * self.rate;
        let steady = mu * self.rate;
        (mu * speed, (steady + speed * slope).max(SLOPE_MIN * steady))
    }

    /// Coefficient where it is the same everywhere; that at no clearance else \[pressure·time/length\].
    pub fn coefficient(&self) -> f64 {
        match self.viscosity {
            Viscosity::Ramps([first, second]) => first.coefficient + second.coefficient,
            Viscosity::Constant(mu) => mu,
        }
    }

    /// Viscous pressure \[pressure\].
    pub fn pressure(&self, overclosure: f64) -> f64 {
        self.evaluate(overclosure).0
    }
}

impl Row {
    /// Whether anything but a wall acts.
    pub fn has_curve(&self) -> bool {
        self.curve != Curve::None || self.dashpot.is_some()
    }

    /// Pressure, slope and energy of the curve alone.
    pub fn law(&self, behaviors: &[NormalBehavior], overclosure: f64) -> LawPoint {
        self.law_of(|index| &behaviors[index], overclosure)
    }

    /// The same with behaviours from anywhere.
    pub fn law_of<'a>(&self, behavior: impl Fn(usize) -> &'a NormalBehavior, overclosure: f64) -> LawPoint {
        match self.curve {
            Curve::None => LawPoint::default(),
            Curve::Penalty(penalty) => penalty.evaluate(overclosure),
            Curve::Law(index) => match behavior(index as usize) {
                NormalBehavior::Softened(law) => law.evaluate(overclosure),
                NormalBehavior::Hard => LawPoint::default(),
            },
        }
    }

    /// Force of curve and dashpot.
    pub fn evaluate(&self, behaviors: &[NormalBehavior], overclosure: f64) -> RowPoint {
        let law = self.law(behaviors, overclosure);
        let (viscous, slope) = self.dashpot.map_or((0.0, 0.0), |dashpot| dashpot.evaluate(overclosure));
        RowPoint { force: self.area * (law.pressure + viscous), stiffness: self.area * (law.stiffness + slope) }
    }

    /// Force of the dashpot \[force\].
    pub fn viscous_force(&self, overclosure: f64) -> f64 {
        self.dashpot.map_or(0.0, |dashpot| self.area * dashpot.pressure(overclosure))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::{Exponential, PressureOverclosure};

    fn rows() -> Vec<Row> {
        let damping = Damping { coefficient: 8.0, clearance: 0.1, fraction: 0.4 };
        let dashpot = |viscosity| Some(Dashpot { viscosity, start: -0.07, rate: 2.0 });
        let curves = [
            Curve::None,
            Curve::Law(0),
            Curve::Penalty(Penalty::linear(300.0, 0.01)),
            Curve::Penalty(Penalty::linear(300.0, 0.01).extended()),
            Curve::Penalty(Penalty::nonlinear(100.0, 1e4, 0.01, 0.03, 0.0)),
        ];
        let second = Damping { coefficient: 1.0, clearance: 0.3, fraction: 0.0 };
        let ramps = Viscosity::Ramps([damping, second]);
        let dashpots = [None, dashpot(ramps), dashpot(Viscosity::Constant(3.0))];
        let row = |(curve, dashpot)| Row { area: 0.3, curve, dashpot, ..Row::default() };
        curves.into_iter().flat_map(|c| dashpots.map(|d| (c, d))).map(row).collect()
    }

    #[test]
    fn slopes_are_those_of_the_forces_while_bodies_approach() {
        let law = PressureOverclosure::Exponential(Exponential::new(0.01, 5.0).expect("valid"));
        let behaviors = [NormalBehavior::Softened(law)];
        for row in rows() {
            for h in [-0.06, -0.045, -0.035, -0.005, 0.005, 0.02, 0.04] {
                let step = 1e-7;
                let force = |h| row.evaluate(&behaviors, h).force;
                let difference = (force(h + step) - force(h - step)) / (2.0 * step);
                let slope = row.evaluate(&behaviors, h).stiffness;
                assert!(
                    (slope - difference).abs() <= 1e-5 * (slope.abs() + 1.0),
                    "{row:?} at {h}: {slope} {difference}"
                );
            }
        }
    }

    #[test]
    fn a_dashpot_that_lets_go_keeps_a_positive_slope() {
        for row in rows().iter().filter(|row| row.dashpot.is_some()) {
            for h in [-0.29, -0.09, -0.08] {
                let at = row.evaluate(&[NormalBehavior::Hard], h);
                assert!(at.stiffness > 0.0, "{row:?}");
                assert!(row.viscous_force(h) < 0.0);
            }
        }
    }
}
