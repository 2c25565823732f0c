//! Variables of an FMU and the values behind them.
//!
//! A value reference is the position of the variable in the list, from 0, over all types. One list makes the
//! description that the packer writes and the tables that the library looks up.

use serde::{Deserialize, Serialize};

use crate::lifecycle::Phase;

/// What a variable is to the importer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// Set before the start, and between steps.
    TunableParameter,
    /// Set between steps.
    Input,
    /// Read.
    Output,
}

/// How a value changes between communication points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    /// A real number that may change at any time.
    Continuous,
    /// Changes at certain instants only.
    Discrete,
}

/// Type, start and bounds.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// `Real`.
    Real {
        /// Start value; outputs have none in the description.
        start: f64,
        /// Unit; the packer defines it in SI terms where it can.
        unit: Option<String>,
        /// Smallest meaningful value.
        min: Option<f64>,
    },
    /// `Integer`.
    Integer {
        /// Start value.
        start: i32,
        /// Smallest value.
        min: i32,
        /// Largest value.
        max: i32,
    },
    /// `Enumeration`, numbered from 1.
    Enumeration {
        /// Start value.
        start: i32,
        /// The type.
        definition: &'static EnumerationType,
    },
    /// `String`.
    String {
        /// Start value.
        start: String,
    },
}

/// A type with named values.
#[derive(Debug, PartialEq, Eq)]
pub struct EnumerationType {
    /// Name of the type.
    pub name: &'static str,
    /// One sentence.
    pub description: &'static str,
    /// Names and descriptions of the values 1, 2, ….
    pub items: &'static [(&'static str, &'static str)],
}

/// One variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Unique name.
    pub name: String,
    /// One sentence for people.
    pub description: String,
    /// Role.
    pub causality: Causality,
    /// Change over time.
    pub variability: Variability,
    /// Type, start and bounds.
    pub kind: Kind,
    /// For an output: positions of the variables that change it at once, without a step.
    pub feed_through: Vec<usize>,
    /// For an output: positions of the variables that change it during initialisation.
    pub initial_dependencies: Vec<usize>,
}

/// Where the value of a variable is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// In [`Values::reals`].
    Real(usize),
    /// In [`Values::integers`]; enumerations too.
    Integer(usize),
    /// In [`Values::strings`].
    String(usize),
}

/// All values of an instance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Values {
    /// Real values, in the order of the Real variables.
    pub reals: Vec<f64>,
    /// Integer and enumeration values.
    pub integers: Vec<i32>,
    /// String values.
    pub strings: Vec<String>,
}

/// The variables with their slots.
#[derive(Clone, Debug)]
pub struct VariableTable {
    variables: Vec<Variable>,
    slots: Vec<Slot>,
}

impl VariableTable {
    /// Lays out the values of a list of variables.
    pub fn new(variables: Vec<Variable>) -> Self {
        let (mut reals, mut integers, mut strings) = (0, 0, 0);
        let next = |counter: &mut usize| {
            *counter += 1;
            *counter - 1
        };
        let slots = variables
            .iter()
            .map(|variable| match variable.kind {
                Kind::Real { .. } => Slot::Real(next(&mut reals)),
                Kind::Integer { .. } | Kind::Enumeration { .. } => Slot::Integer(next(&mut integers)),
                Kind::String { .. } => Slot::String(next(&mut strings)),
            })
            .collect();
        Self { variables, slots }
    }

    /// The variables; the position is the value reference.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// Variable and slot behind a value reference.
    pub fn look_up(&self, reference: u32) -> Option<(&Variable, Slot)> {
        let position = reference as usize;
        Some((self.variables.get(position)?, *self.slots.get(position)?))
    }

    /// Slot behind a value reference.
    pub fn slot(&self, reference: u32) -> Option<Slot> {
        self.slots.get(reference as usize).copied()
    }

    /// Start values.
    pub fn start_values(&self) -> Values {
        let mut values = Values::default();
        for variable in &self.variables {
            match &variable.kind {
                Kind::Real { start, .. } => values.reals.push(*start),
                Kind::Integer { start, .. } | Kind::Enumeration { start, .. } => values.integers.push(*start),
                Kind::String { start } => values.strings.push(start.clone()),
            }
        }
        values
    }

    /// Whether `values` has the shape of this table.
    pub fn fits(&self, values: &Values) -> bool {
        let count = |wanted: fn(&Slot) -> bool| self.slots.iter().filter(|slot| wanted(slot)).count();
        values.reals.len() == count(|slot| matches!(slot, Slot::Real(_)))
            && values.integers.len() == count(|slot| matches!(slot, Slot::Integer(_)))
            && values.strings.len() == count(|slot| matches!(slot, Slot::String(_)))
    }
}

impl Variable {
    /// Whether the importer may set this variable in a phase.
    pub fn settable_in(&self, phase: Phase) -> bool {
        match self.causality {
            Causality::Output => false,
            Causality::Input | Causality::TunableParameter => {
                matches!(phase, Phase::Instantiated | Phase::Initialization | Phase::StepComplete)
            }
        }
    }

    /// Refuses integers outside the bounds of the variable.
    pub fn check_integer(&self, value: i32) -> Result<(), String> {
        match &self.kind {
            Kind::Integer { min, max, .. } if !(*min..=*max).contains(&value) => {
                Err(format!("{}: {value} lies outside {min} to {max}", self.name))
            }
            Kind::Enumeration { definition, .. } if value < 1 || value as usize > definition.items.len() => {
                let items: Vec<String> =
                    definition.items.iter().zip(1..).map(|((name, _), number)| format!("{number} {name}")).collect();
                Err(format!("{}: {value} is none of {}", self.name, items.join(", ")))
            }
            _ => Ok(()),
        }
    }
}
