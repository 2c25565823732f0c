//! What computes behind an instance: a deck, or a law.

pub mod deck;
pub mod law;

use crate::status::Fault;
use crate::variables::{Values, VariableTable};

/// The computing side of an instance. Knows nothing of FMI's call order, logs or handles.
pub trait Backend: Send {
    /// Variables, in the order of their value references.
    fn table(&self) -> &VariableTable;

    /// Whether outputs follow inputs at once, without a step.
    fn feeds_through(&self) -> bool;

    /// The importer set the variable at a position.
    fn note_set(&mut self, position: usize);

    /// Start of the initialisation: everything that happens before the first communication point.
    fn begin(&mut self, values: &mut Values) -> Result<(), Fault>;

    /// Brings outputs up to date with inputs and parameters at the present time. When it is refused, no value has changed.
    fn refresh(&mut self, values: &mut Values) -> Result<(), Fault>;

    /// Advances to `elapsed` \[time\] after the start of the experiment and refreshes the outputs.
    fn step(&mut self, elapsed: f64, values: &mut Values) -> Result<(), Fault>;

    /// Back to the state after instantiation.
    fn reset(&mut self);

    /// State beyond the values of the variables.
    fn save(&self) -> Vec<u8>;

    /// Returns to saved bytes. On an error nothing has changed.
    fn restore(&mut self, bytes: &[u8], values: &Values) -> Result<(), String>;
}
