//! Ports: the scalars through which a deck is driven and read from outside.
//!
//! Inputs are the data lines of the last step with a non-zero magnitude; outputs are condensed results that cost
//! no recovery of the interior. One list serves command line, protocol and FMU.

use serde::{Deserialize, Serialize};

pub use crate::outputs::ports_of;
pub use crate::procedure::loading::inputs_of;

/// Dimension of a port's value, for units in other tools.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// \[length\]
    Length,
    /// \[force\]
    Force,
    /// \[pressure\]
    Pressure,
    /// [length/time²]
    Acceleration,
    /// \[length²\]
    Area,
    /// \[energy\]
    Energy,
    /// \[time\]
    Time,
    /// Whole number.
    Count,
    /// \[radian\]
    Angle,
    /// [force·length]
    Moment,
    /// [length/time]
    Velocity,
    /// [radian/time]
    AngularVelocity,
    /// [radian/time²]
    AngularAcceleration,
}

/// One scalar port.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Port {
    /// Unique within inputs and outputs together, e.g. `boundary.NTOP.3` or `contact.SSL_SMA.CFN3`.
    pub name: String,
    /// Dimension.
    pub quantity: Quantity,
    /// Unit declared by `ports.toml`; none otherwise (units are the deck's).
    pub unit: Option<String>,
    /// One sentence for people.
    pub description: String,
}

/// Inputs and outputs, in the order in which values are exchanged.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PortList {
    /// What a master may set.
    pub inputs: Vec<Port>,
    /// What a master may read.
    pub outputs: Vec<Port>,
}

impl PortList {
    /// Position of an input by name.
    pub fn input(&self, name: &str) -> Option<usize> {
        self.inputs.iter().position(|p| p.name == name)
    }

    /// Position of an output by name.
    pub fn output(&self, name: &str) -> Option<usize> {
        self.outputs.iter().position(|p| p.name == name)
    }
}
