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
    pub const AREA: usize = 9;
    pub const LAW_STIFFNESS: usize = 10;
    pub const CLEARANCE_AT_ZERO_PRESSURE: usize = 11;
    pub const PRESSURE_AT_ZERO_CLEARANCE: usize = 12;
    pub const STIFFNESS_MAX: usize = 13;
    /// Followed by the other pressures of the table, then by the overclosures.
    pub const TABLE_PRESSURE: usize = 14;
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
}

/// Position of `table.text` among the String values.
pub const TABLE_TEXT: usize = 0;

/// Outputs that follow from the overclosure alone, and the one that needs the velocity too.
const DESCRIPTIONS: [(&str, &str, &str); 7] = [
    ("pressure", "Pa", "Contact pressure, positive in compression"),
    ("force", "N", "Contact force: pressure times area, pushes the bodies apart"),
    ("stiffness", "Pa/m", "Slope of the pressure with respect to the overclosure"),
    ("force_stiffness", "N/m", "Slope of the force with respect to the overclosure"),
    ("energy", "J/m2", "Integral of the pressure from separation up to the overclosure"),
    ("stored_energy", "J", "Energy stored in the contact: energy times area"),
    ("power", "W", "Power that the contact takes from the bodies: force times closing velocity"),
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
    list.push(real("law.stiffness", parameter, 1e9, "Pa/m", Some(0.0), "Linear law: slope; positive"));
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
        "0 open: no pressure is transmitted; 1 closed",
        Causality::Output,
        Kind::Integer { start: 0, min: 0, max: 1 },
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
        "table.text",
        "Tabular law: the table as p1:h1,p2:h2,... [Pa, m]; when it is not empty, the arrays do not count",
        parameter,
        Kind::String { start: String::new() },
    ));
    connect(&mut list);
    list
}

/// Which outputs follow which variables.
fn connect(list: &mut [Variable]) {
    let settable: Vec<usize> = (0..list.len())
        .filter(|&at| list[at].causality != Causality::Output && at != Reals::CLOSING_VELOCITY)
        .collect();
    for variable in list.iter_mut().filter(|variable| variable.causality == Causality::Output) {
        variable.feed_through.push(Reals::OVERCLOSURE);
        variable.initial_dependencies.clone_from(&settable);
        if variable.name == "power" {
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
        ] {
            assert_eq!(slot(name), Slot::Integer(at), "{name}");
        }
        assert_eq!(slot("table.text"), Slot::String(TABLE_TEXT));
    }
}
