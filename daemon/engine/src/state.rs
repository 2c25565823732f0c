//! The mutable part of an analysis, and its checkpoint.
//!
//! ```text
//! bytes 0..4   "OVCK"
//! bytes 4..8   version, u32 little-endian
//! bytes 8..16  fingerprint of the model, u64 little-endian
//! bytes 16..20 CRC-32 of everything after byte 20, u32 little-endian
//! bytes 20..   the state in postcard: floats are raw little-endian, no pointers, no padding
//! ```

use serde::{Deserialize, Serialize};

use crate::explicit::energies::Ledger;
use crate::simulation::{Energies, RestoreError, WorkCounts};
use crate::solve::condensed::Response;

const MAGIC: [u8; 4] = *b"OVCK";
/// Raised whenever the meaning of the payload changes.
const VERSION: u32 = 4;
const HEADER: usize = 20;

/// What a state must fit besides a state of the same model.
pub struct Shape {
    /// Whether each step is dynamic.
    pub dynamic: Vec<bool>,
    /// Nodes of the mesh.
    pub nodes: usize,
}

/// Where a dynamic analysis stands. Nodal vectors have an entry for each node of the mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// Displacement \[length\].
    pub displacement: Vec<[f64; 3]>,
    /// Velocity [length/time]; in an explicit step that of the middle of the last increment.
    pub velocity: Vec<[f64; 3]>,
    /// Acceleration [length/time²]; in an explicit step that of the start of the last increment.
    pub acceleration: Vec<[f64; 3]>,
    /// Reaction at prescribed directions \[force\], zero elsewhere.
    pub reaction: Vec<[f64; 3]>,
    /// Internal less external forces, softened contact and dampers among the former \[force\]; empty in explicit steps.
    pub unbalance: Vec<[f64; 3]>,
    /// Overclosure that each contact row counts as none: where it was when it closed in an impact \[length\].
    pub offsets: Vec<f64>,
    /// Rate of each real column [unit/time], and at the start of the step.
    pub rates: Vec<f64>,
    /// See `rates`.
    pub rates_start: Vec<f64>,
    /// Second rate of each real column [unit/time²].
    pub curvatures: Vec<f64>,
    /// Size of the last increment \[time\]; 0 before the first.
    pub increment_last: f64,
    /// Whether each contact point has opened at the present time: one that closes again at that time stays closed until time goes on.
    pub opened: Vec<bool>,
    /// Events in a row that ended their increments.
    pub located: u32,
    /// Largest momentum of a node so far \[force·time\].
    pub momentum_max: f64,
    /// Largest force so far \[force\]: what half-increment residuals are compared with.
    pub force_max: f64,
    /// ETOTAL at the start of the step, and the largest energy since \[energy\].
    pub energy_start: f64,
    /// See `energy_start`.
    pub energy_max: f64,
    /// Energies at the end of the last increment; in an explicit step at its start.
    pub energies: Energies,
    /// Of explicit steps: what the energies are made of.
    pub ledger: Ledger,
    /// Of explicit steps: size of the last increment, that of an earlier step too; 0 before the first \[time\].
    pub size_before: f64,
}

impl Motion {
    /// Force against which rounding is judged: the largest so far, or what would stop the largest momentum within an increment \[force\].
    pub fn force_scale(&self, increment: f64) -> f64 {
        self.force_max.max(self.momentum_max / increment)
    }
}

/// Everything that an increment changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Index of the step.
    pub step: u32,
    /// Time since the start of the step.
    pub step_time: f64,
    /// Next automatic increment.
    pub increment_next: f64,
    /// Step time from which increments of the present size are counted, and how many of them are done: their ends are
    /// `anchor + k · size`, so that they have the same bits whoever asks for them.
    pub increment_anchor: f64,
    /// See `increment_anchor`.
    pub increment_index: u32,
    /// Easy increments in a row.
    pub easy_increments: u32,
    /// Work per step begun so far.
    pub counts: Vec<WorkCounts>,
    /// Present coefficient of each column.
    pub coefficients: Vec<f64>,
    /// Coefficient of each column at the start of the step.
    pub step_start: Vec<f64>,
    /// Replaced magnitude of each input, if any.
    pub magnitudes: Vec<Option<f64>>,
    /// Whether each input is driven from outside.
    pub driven: Vec<bool>,
    /// Value that each input shall have at the end of the next advance.
    pub pending: Vec<Option<f64>>,
    /// Contact force of each point \[force\].
    pub forces: Vec<f64>,
    /// Status of each point.
    pub closed: Vec<bool>,
    /// Whether each contact point has closed under NO SEPARATION.
    pub latched: Vec<bool>,
    /// Whether each contact point sticks.
    pub stuck: Vec<bool>,
    /// Multipliers of augmented Lagrange at each contact point \[pressure\].
    pub multipliers: Vec<f64>,
    /// Overclosures of the points of augmented Lagrange, which have more digits than forces give \[length\].
    pub penetrations: Vec<f64>,
    /// Relative tangential displacement at which each contact point sticks or would, first tangents then second [length].
    pub origins: Vec<f64>,
    /// Force of the dashpot of each row at the end of the last increment \[force\].
    pub viscous: Vec<f64>,
    /// Force of each row when its pair was removed; it goes to zero over that step \[force\].
    pub removed: Vec<f64>,
    /// Work that the dashpots have dissipated \[energy\].
    pub damping_work: f64,
    /// Relative tangential displacement of each point since the start, first tangents then second [length].
    pub tangential: Vec<f64>,
    /// Accumulated slip while closed, in the same layout [length].
    pub slip: Vec<f64>,
    /// Displacement of each motion of bodies that only contact holds: the length that its fastest node has moved.
    pub motions: Vec<f64>,
    /// Springs on the motions that led to the last balance [force/length].
    pub springs: Vec<f64>,
    /// Work-conjugate value of each real column at the end of the last increment.
    pub conjugates: Vec<f64>,
    /// ALLWK \[energy\].
    pub external_work: f64,
    /// Total time of the last status change; 0 before the first.
    pub last_change: f64,
    /// In dynamic steps.
    pub motion: Option<Motion>,
}

impl State {
    /// The solution.
    pub fn response(&self) -> Response<'_> {
        Response { coefficients: &self.coefficients, forces: &self.forces, motions: &self.motions }
    }

    /// Bytes of a checkpoint.
    pub fn encode(&self, fingerprint: u64) -> Vec<u8> {
        let payload = postcard::to_stdvec(self).expect("a plain struct of numbers always encodes");
        let mut bytes = Vec::with_capacity(HEADER + payload.len());
        bytes.extend(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(fingerprint.to_le_bytes());
        bytes.extend(crc32fast::hash(&payload).to_le_bytes());
        bytes.extend(payload);
        bytes
    }

    /// Reads a checkpoint and checks that it has the shape of `like`.
    pub fn decode(bytes: &[u8], fingerprint: u64, like: &State, shape: &Shape) -> Result<Self, RestoreError> {
        let damaged = |detail: &str| RestoreError::Damaged { detail: detail.into() };
        let payload = Self::check(bytes, fingerprint)?;
        let (state, rest) =
            postcard::take_from_bytes::<State>(payload).map_err(|_| damaged("the payload cannot be decoded"))?;
        Self::check_shape(state, rest, like, shape)
    }

    /// Payload of a checkpoint of a model; refuses other files and damaged ones.
    pub fn check(bytes: &[u8], fingerprint: u64) -> Result<&[u8], RestoreError> {
        let damaged = |detail: &str| RestoreError::Damaged { detail: detail.into() };
        let Some((header, payload)) = bytes.split_at_checked(HEADER) else {
            return Err(damaged("shorter than its header"));
        };
        let word = |at: usize| u32::from_le_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]);
        if header[..4] != MAGIC {
            return Err(damaged("it does not begin with OVCK"));
        }
        if word(4) != VERSION {
            return Err(RestoreError::Version { found: word(4), supported: VERSION });
        }
        let found = u64::from(word(8)) | u64::from(word(12)) << 32;
        if found != fingerprint {
            return Err(RestoreError::OtherModel { found, expected: fingerprint });
        }
        if word(16) != crc32fast::hash(payload) {
            return Err(damaged("the checksum does not match"));
        }
        Ok(payload)
    }

    /// A state whose lists are as long as those of `like`.
    fn check_shape(state: State, rest: &[u8], like: &State, shape: &Shape) -> Result<Self, RestoreError> {
        let damaged = |detail: &str| RestoreError::Damaged { detail: detail.into() };
        let lengths = |s: &State| {
            [
                s.coefficients.len(),
                s.step_start.len(),
                s.magnitudes.len(),
                s.driven.len(),
                s.pending.len(),
                s.forces.len(),
                s.closed.len(),
                s.tangential.len(),
                s.latched.len(),
                s.stuck.len(),
                s.multipliers.len(),
                s.penetrations.len(),
                s.origins.len(),
                s.viscous.len(),
                s.removed.len(),
                s.slip.len(),
                s.motions.len(),
                s.springs.len(),
                s.conjugates.len(),
            ]
        };
        let (step, steps) = (state.step as usize, shape.dynamic.len());
        let nodes = shape.nodes;
        let moves = |m: &Motion| {
            let vectors = [&m.displacement, &m.velocity, &m.acceleration, &m.reaction];
            vectors.iter().all(|v| v.len() == nodes)
                && (m.unbalance.is_empty() || m.unbalance.len() == nodes)
                && m.offsets.len() == state.forces.len()
                && m.opened.len() == state.latched.len()
                && [&m.rates, &m.rates_start, &m.curvatures].iter().all(|v| v.len() == state.coefficients.len())
        };
        let dynamic = shape.dynamic.get(step).copied();
        if Some(state.motion.is_some()) != dynamic || !state.motion.as_ref().is_none_or(moves) {
            return Err(damaged("the payload does not fit this model"));
        }
        if !rest.is_empty() || lengths(&state) != lengths(like) || step >= steps || state.counts.len() != step + 1 {
            return Err(damaged("the payload does not fit this model"));
        }
        Ok(state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state() -> State {
        State {
            step: 0,
            step_time: 0.25,
            increment_next: 0.05,
            increment_anchor: 0.0,
            increment_index: 5,
            easy_increments: 1,
            counts: vec![WorkCounts::default()],
            coefficients: vec![1.5, -0.0],
            step_start: vec![0.0, 0.0],
            magnitudes: vec![None],
            driven: vec![true],
            pending: vec![Some(f64::MIN_POSITIVE)],
            forces: vec![0.1, 0.2, 0.3],
            closed: vec![true, false, true],
            latched: vec![false, true, false],
            stuck: vec![false, false, true],
            multipliers: vec![0.0, 7.5, 0.0],
            penetrations: vec![0.0, 1e-7, 0.0],
            origins: vec![-1e-9; 6],
            viscous: vec![-0.25; 3],
            removed: vec![0.0; 3],
            damping_work: 0.375,
            tangential: vec![0.0; 6],
            slip: vec![1e-300; 6],
            motions: vec![-0.5],
            springs: vec![1e3],
            conjugates: vec![2.0, 3.0],
            external_work: 0.125,
            last_change: 0.2,
            motion: None,
        }
    }

    fn statics() -> Shape {
        Shape { dynamic: vec![false], nodes: 2 }
    }

    #[test]
    fn a_motion_fits_the_mesh_and_the_step() {
        let dynamic = Shape { dynamic: vec![true], nodes: 2 };
        let vector = vec![[0.5, -0.0, 1.0]; 2];
        let motion = Motion {
            displacement: vector.clone(),
            velocity: vector.clone(),
            acceleration: vector.clone(),
            reaction: vector,
            offsets: vec![0.0; 3],
            opened: vec![false; 3],
            rates: vec![0.0; 2],
            rates_start: vec![0.0; 2],
            curvatures: vec![0.0; 2],
            ..Motion::default()
        };
        let moving = State { motion: Some(motion), ..state() };
        let bytes = moving.encode(7);
        assert_eq!(State::decode(&bytes, 7, &state(), &dynamic).expect("own bytes"), moving);
        assert!(State::decode(&bytes, 7, &state(), &statics()).is_err());
        assert!(State::decode(&bytes, 7, &state(), &Shape { nodes: 3, ..dynamic }).is_err());
    }

    #[test]
    fn a_checkpoint_comes_back_bit_for_bit() {
        let bytes = state().encode(7);
        let back = State::decode(&bytes, 7, &state(), &statics()).expect("own bytes");
        assert_eq!(back, state());
        assert!(back.coefficients[1].is_sign_negative());
    }

    #[test]
    fn every_damaged_byte_and_every_cut_is_refused() {
        let bytes = state().encode(7);
        for at in 0..bytes.len() {
            let mut bad = bytes.clone();
            bad[at] ^= 0x41;
            assert!(State::decode(&bad, 7, &state(), &statics()).is_err(), "byte {at}");
            assert!(State::decode(&bytes[..at], 7, &state(), &statics()).is_err(), "cut at {at}");
        }
    }

    #[test]
    fn another_model_or_version_is_named() {
        let mut bytes = state().encode(7);
        assert_eq!(
            State::decode(&bytes, 8, &state(), &statics()),
            Err(RestoreError::OtherModel { found: 7, expected: 8 })
        );
        bytes[4] = 9;
        assert_eq!(
            State::decode(&bytes, 7, &state(), &statics()),
            Err(RestoreError::Version { found: 9, supported: VERSION })
        );
    }
}
