//! Prepared models, shared by the sessions of identical decks.

use std::collections::HashMap;
use std::collections::hash_map::RandomState;
use std::hash::BuildHasher;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use overclosure::deck;
use overclosure::diagnostic::Diagnostic;
use overclosure::simulation::{Cache, PrepareOptions, PreparedModel};
use overclosure_protocol::message::{Dialect, OpenRequest, SolverPath};

use super::convert;
use crate::cli::memory;

/// A prepared model and what the reader and the preparation had to say.
pub struct SharedModel {
    /// The model.
    pub prepared: Arc<PreparedModel>,
    /// Warnings of the reader, then of the preparation.
    pub warnings: Vec<Diagnostic>,
}

/// Identity of a deck and everything that changes its preparation. Not the threads: the numbers do not depend on them.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Key {
    /// Two hashes under keys that nobody outside knows, and the length: decks that collide cannot be made on purpose.
    deck: (u64, u64, usize),
    dialect: Dialect,
    path: SolverPath,
    ports_toml: Option<String>,
}

type Slot = Arc<Mutex<Weak<SharedModel>>>;

/// Models in use. A model is dropped from memory with its last session.
pub struct Models {
    /// Bytes that a preparation may take; what is left when it begins unless given.
    memory_limit: Option<u64>,
    /// Where models are kept on disk, if anywhere.
    cache: Option<Cache>,
    slots: Mutex<HashMap<Key, Slot>>,
    hashers: (RandomState, RandomState),
}

impl Models {
    /// No models yet.
    pub fn new(memory_limit: Option<u64>, cache: Option<PathBuf>) -> Self {
        let cache = cache.map(Cache::Directory);
        Self { memory_limit, cache, slots: Mutex::default(), hashers: <(RandomState, RandomState)>::default() }
    }

    /// The model of a deck: the one in use, or a new one. A second session of the same deck waits for the first
    /// preparation. Errors are the findings about the deck.
    pub fn obtain(&self, request: &OpenRequest) -> Result<Arc<SharedModel>, Vec<Diagnostic>> {
        let key = Key {
            deck: (self.hashers.0.hash_one(&request.deck), self.hashers.1.hash_one(&request.deck), request.deck.len()),
            dialect: request.dialect,
            path: request.path,
            ports_toml: request.ports_toml.clone(),
        };
        let slot = {
            let mut slots = self.slots.lock().unwrap_or_else(PoisonError::into_inner);
            // A slot that nobody holds and whose model is gone has served.
            slots.retain(|_, slot| Arc::strong_count(slot) > 1 || alive(slot));
            slots.entry(key).or_default().clone()
        };
        // A preparation that panicked leaves the slot as it was: empty.
        let mut model = slot.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(shared) = model.upgrade() {
            return Ok(shared);
        }
        let shared = Arc::new(prepare(request, self.memory_limit.or_else(memory::available), self.cache.clone())?);
        *model = Arc::downgrade(&shared);
        Ok(shared)
    }

    /// Number of models in memory.
    pub fn count(&self) -> usize {
        self.slots.lock().unwrap_or_else(PoisonError::into_inner).values().filter(|slot| alive(slot)).count()
    }
}

/// A slot that is locked is being prepared: not alive yet, and held by the one who prepares.
fn alive(slot: &Slot) -> bool {
    slot.try_lock().is_ok_and(|model| model.strong_count() > 0)
}

fn prepare(
    request: &OpenRequest,
    memory_limit: Option<u64>,
    cache: Option<Cache>,
) -> Result<SharedModel, Vec<Diagnostic>> {
    let reading = deck::read_text(&request.deck, convert::dialect(request.dialect));
    let mut warnings = reading.diagnostics;
    let Some(model) = reading.model else { return Err(warnings) };
    let options = PrepareOptions {
        path: convert::path(request.path),
        threads: request.threads as usize,
        ports_toml: request.ports_toml.clone(),
        memory_limit,
        cache,
    };
    match PreparedModel::prepare(model, &options, &mut |phase| tracing::debug!(?phase, "preparing")) {
        Ok(prepared) => {
            warnings.extend_from_slice(prepared.warnings());
            Ok(SharedModel { prepared: Arc::new(prepared), warnings })
        }
        Err(findings) => {
            warnings.extend(findings);
            Err(warnings)
        }
    }
}
