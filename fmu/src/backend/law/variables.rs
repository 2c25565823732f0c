//! Variables of the law FMU: which there are, and where their values stand.

use crate::variables::{Causality, EnumerationType, Kind, Variability, Variable};

/// Most points of the table given as arrays. `table.text` has no such limit.
pub const TABLE_POINTS_MAX: usize = 100;

/// The kinds of law.
pub static LAW_KIND: EnumerationType = EnumerationType {
    name: "LawKind",
    description: "Pressure-overclosure relationship",
    items: &[
        ("linear", "pressure proportional to the overclosure"),
        ("tabular", "piecewise linear"),
        ("exponential", "exponential curve of the Abaqus manual"),
        ("calculix_exponential", "exponential curve of CalculiX"),
        ("penalty", "straight penalty for hard contact"),
        ("nonlinear_penalty", "penalty for hard contact that stiffens"),
        ("augmented_lagrange", "straight penalty with the multiplier of an augmentation"),
    ],
};

/// Positions among the Real values.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Reals;

#[allow(missing_docs)]
impl Reals {
    pub const OVERCLOSURE: usize = 0;
    pub const CLOSING_VELOCITY: usize = 1;
    pub const PRESSURE: usize = 2;
    pub const FORCE: usize = 3;
    pub const STIFFNESS: usize = 4;
    pub const FORCE_STIFFNESS: usize = 5;
    pub const ENERGY: usize = 6;
    pub const STORED_ENERGY: usize = 7;
    pub const POWER: usize = 8;
    pub const VISCOUS_PRESSURE: usize = 9;
    pub const DAMPING_COEFFICIENT: usize = 10;
    pub const FORCE_DAMPING: usize = 11;
    pub const DISSIPATED_POWER: usize = 12;
    pub const AREA: usize = 13;
    pub const LAW_STIFFNESS: usize = 14;
    pub const CLEARANCE_AT_ZERO_PRESSURE: usize = 15;
    pub const PRESSURE_AT_ZERO_CLEARANCE: usize = 16;
    pub const STIFFNESS_MAX: usize = 17;
    pub const PENALTY_CLEARANCE: usize = 18;
    pub const PENALTY_MULTIPLIER: usize = 19;
    pub const PENALTY_STIFFNESS_INITIAL: usize = 20;
    pub const PENALTY_STIFFNESS_FINAL: usize = 21;
    pub const PENALTY_LOWER: usize = 22;
    pub const PENALTY_UPPER: usize = 23;
    pub const DAMPING_COEFFICIENT_MAX: usize = 24;
    pub const DAMPING_CLEARANCE: usize = 25;
    pub const DAMPING_FRACTION: usize = 26;
    /// Followed by the other pressures of the table, then by the overclosures.
    pub const TABLE_PRESSURE: usize = 27;
    pub const TABLE_OVERCLOSURE: usize = Self::TABLE_PRESSURE + TABLE_POINTS_MAX;
}

/// Positions among the Integer values.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub struct Integers;

#[allow(missing_docs)]
impl Integers {
    pub const STATUS: usize = 0;
    pub const KIND: usize = 1;
    pub const KIND_INTEGER: usize = 2;
    pub const TABLE_N: usize = 3;
    pub const SEPARATION: usize = 4;
}

/// Position of `table.text` among the String values.
pub const TABLE_TEXT: usize = 0;

/// The Real outputs: name, unit, description.
const DESCRIPTIONS: [(&str, &str, &str); 11] = [
    ("pressure", "Pa", "Contact pressure of the law, positive in compression"),
    ("force", "N", "Contact force, pushes the bodies apart: pressure and viscous_pressure times area"),
    ("stiffness", "Pa/m", "Slope of the pressure with respect to the overclosure"),
    ("force_stiffness", "N/m", "Slope of the force with respect to the overclosure"),
    ("energy", "J/m2", "Integral of the pressure from separation up to the overclosure"),
    ("stored_energy", "J", "Energy stored in the contact: energy times area"),
    ("power", "W", "Power that the contact takes from the bodies: force times closing velocity"),
    (
        "viscous_pressure",
        "Pa",
        "Pressure of the contact damping: coefficient times closing velocity; negative is suction",
    ),
    ("damping_coefficient", "Pa.s/m", "Coefficient of the contact damping at the overclosure"),
    ("force_damping", "N.s/m", "Slope of the force with respect to the closing velocity"),
    ("dissipated_power", "W", "Power that the contact damping dissipates; never negative"),
];

/// Parameters of the penalties and of contact damping: name, start, unit, minimum, description.
const OTHER_PARAMETERS: [(&str, f64, &str, Option<f64>, &str); 9] = [
    ("penalty.clearance", 0.0, "m", Some(0.0), "Penalties: clearance c0 at which the pressure begins"),
    ("penalty.multiplier", 0.0, "Pa", None, "Augmented Lagrange: multiplier; negative only when law.separation is 1"),
    ("penalty.stiffness_initial", 1e8, "Pa/m", Some(0.0), "Nonlinear penalty: slope Ki up to penalty.lower; positive"),
    ("penalty.stiffness_final", 1e10, "Pa/m", Some(0.0), "Nonlinear penalty: slope Kf beyond penalty.upper"),
    ("penalty.lower", 1e-5, "m", Some(0.0), "Nonlinear penalty: overclosure d at which the slope begins to rise"),
    ("penalty.upper", 3e-5, "m", Some(0.0), "Nonlinear penalty: overclosure e at which the slope has risen; beyond d"),
    ("damping.coefficient", 0.0, "Pa.s/m", Some(0.0), "Contact damping: coefficient mu0 in contact; 0 for none"),
    ("damping.clearance", 1e-4, "m", Some(0.0), "Contact damping: clearance c0 at which it has vanished; positive"),
    ("damping.fraction", 0.0, "1", Some(0.0), "Contact damping: part eta of c0 without decrease, below 1"),
];

/// All variables, in the order of their value references.
pub fn variables() -> Vec<Variable> {
    let mut list = vec![
        real("overclosure", Causality::Input, 0.0, "m", None, "Overclosure, positive when the bodies overlap"),
        real(
            "closing_velocity",
            Causality::Input,
            0.0,
            "m/s",
            None,
            "Rate of the overclosure, positive when the bodies approach",
        ),
    ];
    for (name, unit, description) in DESCRIPTIONS {
        list.push(real(name, Causality::Output, 0.0, unit, None, description));
    }
    let parameter = Causality::TunableParameter;
    list.push(real("area", parameter, 1.0, "m2", Some(0.0), "Area on which the pressure acts; positive"));
    list.push(real(
        "law.stiffness",
        parameter,
        1e9,
        "Pa/m",
        Some(0.0),
        "Linear law, penalty, augmented Lagrange: slope; positive",
    ));
    list.push(real(
        "law.clearance_at_zero_pressure",
        parameter,
        1e-4,
        "m",
        Some(0.0),
        "Exponential laws: clearance c0 at which the pressure begins; positive",
    ));
    list.push(real(
        "law.pressure_at_zero_clearance",
        parameter,
        1e6,
        "Pa",
        Some(0.0),
        "Exponential laws: pressure p0 at zero clearance; positive",
    ));
    list.push(real(
        "law.stiffness_max",
        parameter,
        0.0,
        "Pa/m",
        Some(0.0),
        "Exponential law of Abaqus/Explicit: limit of the slope; 0 for none",
    ));
    for (name, start, unit, min, description) in OTHER_PARAMETERS {
        list.push(real(name, parameter, start, unit, min, description));
    }
    for (column, unit, second, what) in [("pressure", "Pa", 1e6, "pressure"), ("overclosure", "m", 1e-3, "overclosure")]
    {
        for row in 1..=TABLE_POINTS_MAX {
            let start = if row == 2 { second } else { 0.0 };
            let description = format!("Tabular law: {what} of point {row}; must increase from point to point");
            list.push(real(&format!("table.{column}[{row}]"), parameter, start, unit, None, &description));
        }
    }
    let discrete = |name: &str, description: &str, causality: Causality, kind: Kind| Variable {
        name: name.into(),
        description: description.into(),
        causality,
        variability: Variability::Discrete,
        kind,
        feed_through: Vec::new(),
        initial_dependencies: Vec::new(),
    };
    list.push(discrete(
        "status",
        "0 open: no pressure is transmitted; 1 closed; 2 open with a viscous pressure (VD)",
        Causality::Output,
        Kind::Integer { start: 0, min: 0, max: 2 },
    ));
    list.push(discrete("law.kind", "Which law", parameter, Kind::Enumeration { start: 1, definition: &LAW_KIND }));
    list.push(discrete(
        "law.kind_integer",
        "For importers without enumerations: number of the law; 0 leaves the choice to law.kind",
        parameter,
        Kind::Integer { start: 0, min: 0, max: LAW_KIND.items.len() as i32 },
    ));
    list.push(discrete(
        "table.n",
        "Tabular law: number of points that count, from the first on",
        parameter,
        Kind::Integer { start: 2, min: 2, max: TABLE_POINTS_MAX as i32 },
    ));
    list.push(discrete(
        "law.separation",
        "0 allowed; 1 prevented: the surfaces have met before, and the law goes on into tension",
        parameter,
        Kind::Integer { start: 0, min: 0, max: 1 },
    ));
    list.push(discrete(
        "table.text",
        "Tabular law: the table as p1:h1,p2:h2,... [Pa, m]; when it is not empty, the arrays do not count",
        parameter,
        Kind::String { start: String::new() },
    ));
    connect(&mut list);
    list
}

/// Outputs that follow from the closing velocity too, where there is contact damping.
const WITH_VELOCITY: [&str; 6] =
    ["force", "force_stiffness", "power", "viscous_pressure", "dissipated_power", "status"];

/// Which outputs follow which variables.
fn connect(list: &mut [Variable]) {
    let settable: Vec<usize> = (0..list.len())
        .filter(|&at| list[at].causality != Causality::Output && at != Reals::CLOSING_VELOCITY)
        .collect();
    for variable in list.iter_mut().filter(|variable| variable.causality == Causality::Output) {
        variable.feed_through.push(Reals::OVERCLOSURE);
        variable.initial_dependencies.clone_from(&settable);
        if WITH_VELOCITY.contains(&variable.name.as_str()) {
            variable.feed_through.push(Reals::CLOSING_VELOCITY);
            variable.initial_dependencies.insert(1, Reals::CLOSING_VELOCITY);
        }
    }
}

fn real(name: &str, causality: Causality, start: f64, unit: &str, min: Option<f64>, description: &str) -> Variable {
    Variable {
        name: name.into(),
        description: description.into(),
        causality,
        variability: Variability::Continuous,
        kind: Kind::Real { start, unit: Some(unit.into()), min },
        feed_through: Vec::new(),
        initial_dependencies: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::variables::{Slot, VariableTable};

    #[test]
    fn values_stand_where_the_positions_say() {
        let table = VariableTable::new(variables());
        let slot = |name: &str| {
            let reference = table.variables().iter().position(|variable| variable.name == name).expect(name);
            table.slot(reference as u32).expect("in the list")
        };
        for (name, at) in [
            ("overclosure", Reals::OVERCLOSURE),
            ("closing_velocity", Reals::CLOSING_VELOCITY),
            ("pressure", Reals::PRESSURE),
            ("force", Reals::FORCE),
            ("stiffness", Reals::STIFFNESS),
            ("force_stiffness", Reals::FORCE_STIFFNESS),
            ("energy", Reals::ENERGY),
            ("stored_energy", Reals::STORED_ENERGY),
            ("power", Reals::POWER),
            ("viscous_pressure", Reals::VISCOUS_PRESSURE),
            ("damping_coefficient", Reals::DAMPING_COEFFICIENT),
            ("force_damping", Reals::FORCE_DAMPING),
            ("dissipated_power", Reals::DISSIPATED_POWER),
            ("penalty.clearance", Reals::PENALTY_CLEARANCE),
            ("penalty.multiplier", Reals::PENALTY_MULTIPLIER),
            ("penalty.stiffness_initial", Reals::PENALTY_STIFFNESS_INITIAL),
            ("penalty.stiffness_final", Reals::PENALTY_STIFFNESS_FINAL),
            ("penalty.lower", Reals::PENALTY_LOWER),
            ("penalty.upper", Reals::PENALTY_UPPER),
            ("damping.coefficient", Reals::DAMPING_COEFFICIENT_MAX),
            ("damping.clearance", Reals::DAMPING_CLEARANCE),
            ("damping.fraction", Reals::DAMPING_FRACTION),
            ("area", Reals::AREA),
            ("law.stiffness", Reals::LAW_STIFFNESS),
            ("law.clearance_at_zero_pressure", Reals::CLEARANCE_AT_ZERO_PRESSURE),
            ("law.pressure_at_zero_clearance", Reals::PRESSURE_AT_ZERO_CLEARANCE),
            ("law.stiffness_max", Reals::STIFFNESS_MAX),
            ("table.pressure[1]", Reals::TABLE_PRESSURE),
            ("table.overclosure[1]", Reals::TABLE_OVERCLOSURE),
        ] {
            assert_eq!(slot(name), Slot::Real(at), "{name}");
        }
        for (name, at) in [
            ("status", Integers::STATUS),
            ("law.kind", Integers::KIND),
            ("law.kind_integer", Integers::KIND_INTEGER),
            ("table.n", Integers::TABLE_N),
            ("law.separation", Integers::SEPARATION),
        ] {
            assert_eq!(slot(name), Slot::Integer(at), "{name}");
        }
        assert_eq!(slot("table.text"), Slot::String(TABLE_TEXT));
    }
}
