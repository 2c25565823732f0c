//! From the arguments of `fmi2Instantiate` to an instance.

use std::path::PathBuf;

use crate::backend::Backend;
use crate::backend::deck::{self, DeckBackend};
use crate::backend::law::LawBackend;
use crate::instance::Instance;
use crate::log::Log;
use crate::resources::{self, Content, ResourceError};

/// Arguments of `fmi2Instantiate`; missing strings are empty.
#[derive(Clone, Debug)]
pub struct Request {
    /// Name of the instance.
    pub name: String,
    /// Whether the importer wants co-simulation.
    pub co_simulation: bool,
    /// GUID from the importer's copy of the description.
    pub guid: String,
    /// Resource location.
    pub location: Option<String>,
    /// File of the library itself.
    pub library: Option<PathBuf>,
}

/// Why there is no instance.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// No name.
    #[error("the instance name is missing, empty or not UTF-8")]
    NoName,
    /// Model exchange.
    #[error("this FMU is for co-simulation only")]
    NotCoSimulation,
    /// Description and library do not belong together.
    #[error("the GUID {given} is not that of this FMU, {expected}")]
    Guid {
        /// From the importer.
        given: String,
        /// From the resources.
        expected: String,
    },
    /// No usable resources.
    #[error(transparent)]
    Resources(#[from] ResourceError),
    /// The deck cannot be solved.
    #[error("the deck of this FMU cannot be prepared:\n{findings}")]
    Deck {
        /// One line per finding.
        findings: String,
    },
}

/// Makes an instance.
pub fn open(request: &Request, log: Log) -> Result<Instance, OpenError> {
    if request.name.trim().is_empty() {
        return Err(OpenError::NoName);
    }
    if !request.co_simulation {
        return Err(OpenError::NotCoSimulation);
    }
    let folder = resources::locate(request.location.as_deref(), request.library.as_deref())?;
    let options = resources::read_options(&folder)?;
    if request.guid != options.guid {
        return Err(OpenError::Guid { given: request.guid.clone(), expected: options.guid });
    }
    let backend: Box<dyn Backend> = match options.content {
        Content::Law => Box::new(LawBackend::default()),
        Content::Deck { dialect, path, ports } => {
            let text = resources::read_deck(&folder, dialect, path, ports)?;
            let prepared = deck::prepare_shared(&text).map_err(|findings| OpenError::Deck { findings })?;
            Box::new(DeckBackend::new(prepared))
        }
    };
    Ok(Instance::new(options.guid, backend, log))
}
