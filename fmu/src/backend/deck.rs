//! A deck inside an FMU: the engine behind the variables.
//!
//! Inputs are the input ports of the deck. A port that the importer never sets follows the deck; one that it sets
//! reaches its value linearly over the next step. Steps of the deck before the last one run at initialisation, so
//! the experiment starts where the last step starts.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use overclosure::deck;
use overclosure::diagnostic::Diagnostic;
use overclosure::port::{PortList, Quantity};
use overclosure::simulation::{AdvanceOutcome, Cache, PrepareOptions, PreparedModel, Simulation};
use serde::{Deserialize, Serialize};

use super::Backend;
use crate::resources::DeckText;
use crate::status::Fault;
use crate::variables::{Causality, Kind, Values, Variability, Variable, VariableTable};

/// Findings quoted in one message; the rest is counted.
const FINDINGS_QUOTED_MAX: usize = 20;

/// Variables of a deck: inputs, then outputs. `starts` has one value per input.
pub fn variables(ports: &PortList, starts: &[f64]) -> Vec<Variable> {
    let inputs = ports.inputs.iter().zip(starts).map(|(port, &start)| Variable {
        name: port.name.clone(),
        description: port.description.clone(),
        causality: Causality::Input,
        variability: Variability::Continuous,
        kind: Kind::Real { start, unit: port.unit.clone(), min: None },
        feed_through: Vec::new(),
        initial_dependencies: Vec::new(),
    });
    let outputs = ports.outputs.iter().map(|port| Variable {
        name: port.name.clone(),
        description: port.description.clone(),
        causality: Causality::Output,
        variability: match port.quantity {
            Quantity::Count | Quantity::Time => Variability::Discrete,
            _ => Variability::Continuous,
        },
        kind: Kind::Real { start: 0.0, unit: port.unit.clone(), min: None },
        // The deck answers to new inputs at the next step.
        feed_through: Vec::new(),
        initial_dependencies: (0..ports.inputs.len()).collect(),
    });
    inputs.chain(outputs).collect()
}

/// Reads and prepares a deck, or hands out the model that another instance has prepared from the same text.
pub fn prepare_shared(text: &DeckText) -> Result<Arc<PreparedModel>, String> {
    let slot = {
        let mut registry = registry().lock().unwrap_or_else(PoisonError::into_inner);
        registry.retain(|_, slot| Arc::strong_count(slot) > 1 || is_alive(slot));
        Arc::clone(registry.entry(text.fingerprint()).or_default())
    };
    // One preparation per text; other texts do not wait for it.
    let mut shared = slot.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(prepared) = shared.upgrade() {
        return Ok(prepared);
    }
    let prepared = Arc::new(prepare(text)?);
    *shared = Arc::downgrade(&prepared);
    Ok(prepared)
}

/// Reads and prepares a deck; takes the prepared model of the FMU if there is one.
pub fn prepare(text: &DeckText) -> Result<PreparedModel, String> {
    let reading = deck::read_text(&text.deck, text.dialect);
    let model = reading.model.ok_or_else(|| quote(&reading.diagnostics))?;
    let options = PrepareOptions {
        path: text.path,
        threads: 1,
        ports_toml: text.ports.clone(),
        cache: text.prepared.clone().map(Cache::File),
        ..PrepareOptions::default()
    };
    PreparedModel::prepare(model, &options, &mut |_| {}).map_err(|findings| quote(&findings))
}

/// A running deck.
pub struct DeckBackend {
    table: VariableTable,
    simulation: Simulation,
    inputs: usize,
    state: DriveState,
}

/// What the engine's checkpoint does not hold.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct DriveState {
    /// Total time at which the experiment starts: the beginning of the last step \[time\].
    origin: f64,
    /// Inputs set since the last step.
    pending: Vec<bool>,
}

impl DeckBackend {
    /// At the start of the deck.
    pub fn new(prepared: Arc<PreparedModel>) -> Self {
        let inputs = prepared.ports().inputs.len();
        let table = VariableTable::new(variables(prepared.ports(), &vec![0.0; inputs]));
        let state = DriveState { origin: 0.0, pending: vec![false; inputs] };
        Self { table, simulation: Simulation::new(prepared), inputs, state }
    }

    fn advance(&mut self, target: f64, values: &mut Values) -> Result<(), Fault> {
        for (input, pending) in self.state.pending.iter_mut().enumerate() {
            if *pending {
                let value = values.reals[input];
                self.simulation.set(input, value).map_err(|error| Fault::Refused(error.to_string()))?;
                *pending = false;
            }
        }
        let outcome = self.simulation.advance(target, &mut ()).map_err(|error| Fault::Refused(error.to_string()))?;
        self.observe(values);
        self.judge(outcome, values)
    }

    fn observe(&mut self, values: &mut Values) {
        let (inputs, outputs) = values.reals.split_at_mut(self.inputs);
        for (input, value) in inputs.iter_mut().enumerate() {
            if let Some(actual) = self.simulation.input(input).filter(|_| !self.state.pending[input]) {
                *value = actual;
            }
        }
        self.simulation.observe(outputs);
    }

    fn judge(&self, outcome: AdvanceOutcome, values: &Values) -> Result<(), Fault> {
        let reason = match outcome {
            AdvanceOutcome::Reached => match values.reals.iter().position(|value| !value.is_finite()) {
                None => return Ok(()),
                Some(at) => {
                    format!("{} is not a finite number: the inputs are out of range", self.table.variables()[at].name)
                }
            },
            AdvanceOutcome::Cancelled => "the advance was cancelled".to_string(),
            AdvanceOutcome::Stopped { reason } => reason,
        };
        Err(Fault::Failed { reason, elapsed: self.simulation.time() - self.state.origin })
    }
}

impl Backend for DeckBackend {
    fn table(&self) -> &VariableTable {
        &self.table
    }

    fn feeds_through(&self) -> bool {
        false
    }

    fn note_set(&mut self, position: usize) {
        if let Some(pending) = self.state.pending.get_mut(position) {
            *pending = true;
        }
    }

    fn begin(&mut self, values: &mut Values) -> Result<(), Fault> {
        let outcome = self.simulation.initialize(&mut ());
        if outcome == AdvanceOutcome::Reached {
            self.state.origin = self.simulation.time();
        }
        self.observe(values);
        self.judge(outcome, values)
    }

    fn refresh(&mut self, values: &mut Values) -> Result<(), Fault> {
        if self.state.pending.contains(&true) {
            let now = self.simulation.time();
            self.advance(now, values)
        } else {
            Ok(())
        }
    }

    fn step(&mut self, elapsed: f64, values: &mut Values) -> Result<(), Fault> {
        // The instance has checked the communication point; what is left is rounding of the importer's clock.
        let target = (self.state.origin + elapsed).max(self.simulation.time());
        self.advance(target, values)
    }

    fn reset(&mut self) {
        self.simulation = Simulation::new(Arc::clone(self.simulation.prepared()));
        self.state = DriveState { origin: 0.0, pending: vec![false; self.inputs] };
    }

    fn save(&self) -> Vec<u8> {
        let state = postcard::to_stdvec(&self.state).expect("a float and a list of booleans always encode");
        let mut bytes = (state.len() as u32).to_le_bytes().to_vec();
        bytes.extend_from_slice(&state);
        bytes.extend_from_slice(&self.simulation.checkpoint());
        bytes
    }

    fn restore(&mut self, bytes: &[u8], _: &Values) -> Result<(), String> {
        let too_short = || "saved state is too short".to_string();
        let (length, rest) = bytes.split_first_chunk::<4>().ok_or_else(too_short)?;
        let length = u32::from_le_bytes(*length) as usize;
        let (state, checkpoint) = rest.split_at_checked(length).ok_or_else(too_short)?;
        let state: DriveState = postcard::from_bytes(state).map_err(|error| error.to_string())?;
        if state.pending.len() != self.inputs || !state.origin.is_finite() {
            return Err(format!("saved state is not one of a deck with {} inputs", self.inputs));
        }
        self.simulation.restore(checkpoint).map_err(|error| error.to_string())?;
        self.state = state;
        Ok(())
    }
}

type Slot = Arc<Mutex<Weak<PreparedModel>>>;

/// Prepared models that live instances hold. Only weak references: nothing stays when the last instance goes.
fn registry() -> &'static Mutex<HashMap<u128, Slot>> {
    static REGISTRY: std::sync::OnceLock<Mutex<HashMap<u128, Slot>>> = std::sync::OnceLock::new();
    REGISTRY.get_or_init(Mutex::default)
}

fn is_alive(slot: &Slot) -> bool {
    slot.lock().unwrap_or_else(PoisonError::into_inner).strong_count() > 0
}

fn quote(findings: &[Diagnostic]) -> String {
    let errors: Vec<String> = findings.iter().filter(|finding| finding.is_error()).map(ToString::to_string).collect();
    let mut text = errors[..errors.len().min(FINDINGS_QUOTED_MAX)].join("\n");
    if errors.len() > FINDINGS_QUOTED_MAX {
        text.push_str(&format!("\nand {} more", errors.len() - FINDINGS_QUOTED_MAX));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One cube, pulled.
    fn text(pull: &str) -> DeckText {
        let deck = format!(
            "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n\
             *ELEMENT, TYPE=C3D8, ELSET=ALL\n1,1,2,3,4,5,6,7,8\n*NSET, NSET=BOTTOM\n1,2,3,4\n*NSET, NSET=TOP\n5,6,7,8\n\
             *MATERIAL, NAME=M\n*ELASTIC\n100., 0.\n*SOLID SECTION, ELSET=ALL, MATERIAL=M\n*BOUNDARY\nBOTTOM,1,3\nTOP,1,2\n\
             *STEP\n*STATIC\n1., 1.\n*BOUNDARY\nTOP,3,3,{pull}\n*NODE PRINT, NSET=TOP\nRF\n*END STEP\n"
        );
        DeckText { deck, ports: None, dialect: Default::default(), path: Default::default(), prepared: None }
    }

    #[test]
    fn instances_of_one_deck_share_the_model_and_let_it_go() {
        let first = prepare_shared(&text("0.1")).expect("a deck");
        let second = prepare_shared(&text("0.1")).expect("a deck");
        assert!(Arc::ptr_eq(&first, &second));
        let other = prepare_shared(&text("0.2")).expect("a deck");
        assert!(!Arc::ptr_eq(&first, &other));
        let watch = Arc::downgrade(&first);
        drop((first, second));
        assert_eq!(watch.strong_count(), 0, "the registry keeps nothing alive");
        assert!(prepare_shared(&text("0.1")).is_ok());
    }

    #[test]
    fn a_wrong_deck_says_why() {
        let mut wrong = text("0.1");
        wrong.deck = wrong.deck.replace("MATERIAL=M\n*BOUNDARY", "MATERIAL=WOOD\n*BOUNDARY");
        let error = prepare_shared(&wrong).err().expect("no such material");
        assert!(error.contains("WOOD"), "{error}");
    }

    #[test]
    fn damaged_state_changes_nothing() {
        let mut backend = DeckBackend::new(prepare_shared(&text("0.3")).expect("a deck"));
        let mut values = backend.table().start_values();
        backend.begin(&mut values).expect("no preload");
        backend.step(0.5, &mut values).expect("a step");
        let bytes = backend.save();
        for cut in 0..bytes.len() {
            assert!(backend.restore(&bytes[..cut], &values).is_err(), "{cut}");
        }
        assert_eq!(backend.save(), bytes);
        backend.restore(&bytes, &values).expect("its own state");
    }
}
