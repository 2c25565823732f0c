//! Pressure-overclosure relationships: what pressure a given overclosure transmits. Imports nothing of the engine.

/// Pressure, its slope and its integral at one overclosure.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LawPoint {
    /// Contact pressure [pressure]; positive pushes the bodies apart.
    pub pressure: f64,
    /// dp/dh [pressure/length].
    pub stiffness: f64,
    /// Integral of the pressure from separation up to `h` [pressure*length].
    pub energy: f64,
}

/// Normal behaviour of an interaction.
#[derive(Clone, Debug, PartialEq)]
pub enum NormalBehavior {
    /// No overclosure, no tension; enforced exactly by multipliers.
    Hard,
    /// A softened law.
    Softened(PressureOverclosure),
}

/// The softened laws.
#[derive(Clone, Debug, PartialEq)]
pub enum PressureOverclosure {}
