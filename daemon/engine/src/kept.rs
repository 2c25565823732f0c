//! The bodies of a model on disk.

use std::path::PathBuf;

use crate::cache::{self, Refused};
use crate::fingerprint::Fnv;
use crate::model::NodeId;
use crate::simulation::Cache;
use crate::solve::bodies::points_of_body;
use crate::solve::body::{Body, BodyContribution};
use crate::solve::context::Context;
use crate::solve::linear::Factor;
use crate::solve::numbering::Bodies;

/// Bodies and what the rest of the model needs of each.
pub type Prepared = (Vec<Body>, Vec<BodyContribution>);

/// Where a model is on disk, or will be.
pub struct Kept {
    path: PathBuf,
    /// Of the model, and of what its bodies are computed from.
    key: u64,
    /// Whether a model that is not there is put there.
    is_written: bool,
}

impl Kept {
    /// Of a model with a certain fingerprint.
    pub fn new(cache: &Cache, context: &Context<'_>, fingerprint: u64) -> Self {
        let key = key(context, fingerprint);
        match cache {
            Cache::Directory(directory) => Self { path: cache::file_in(directory, fingerprint), key, is_written: true },
            Cache::File(path) => Self { path: path.clone(), key, is_written: false },
        }
    }

    /// What is on disk, if it is of this model and whole, and how many numbers of eight bytes that is with its factors.
    pub fn load(&self, context: &Context<'_>, bodies: &Bodies) -> Option<(Prepared, usize)> {
        let file = self.path.display();
        match self.read(context, bodies) {
            Ok(prepared) => {
                tracing::info!(%file, "took the prepared model");
                return Some(prepared);
            }
            Err(refused @ (Refused::Absent | Refused::Other(_))) if self.is_written => {
                tracing::info!(%file, "preparing the model: {refused}");
            }
            Err(refused) => tracing::warn!(%file, "cannot use the prepared model, so it is prepared again: {refused}"),
        }
        None
    }

    fn read(&self, context: &Context<'_>, bodies: &Bodies) -> Result<(Prepared, usize), Refused> {
        let (bytes, (mut prepared, contributions), factors): (_, Prepared, _) = cache::open(&self.path, self.key)?;
        let mut factors = factors.into_iter();
        let count = bodies.nodes.len();
        let fits = prepared.len() == count
            && contributions.len() == count
            && prepared.iter_mut().zip(&contributions).enumerate().all(|(b, (body, contribution))| {
                body.return_to(
                    context,
                    &bodies.nodes[b],
                    &points_of_body(context, bodies, b),
                    contribution,
                    &mut factors,
                )
            });
        if fits && factors.next().is_none() {
            Ok(((prepared, contributions), (bytes / 8) as usize))
        } else {
            Err(Refused::Damaged("its bodies are not those of the model".into()))
        }
    }

    /// Puts bodies that were computed there, unless it is only to be read. A disk that is full is no reason to fail.
    pub fn store(&self, prepared: &Prepared) {
        if !self.is_written {
            return;
        }
        let factors: Vec<&Factor> = prepared.0.iter().filter_map(Body::factor_in_memory).collect();
        match cache::write(&self.path, self.key, prepared, &factors) {
            Ok(()) => tracing::info!(file = %self.path.display(), "kept the prepared model"),
            Err(error) => {
                tracing::warn!(
                    file = %self.path.display(),
                    "the prepared model cannot be kept, so the next start prepares it again: {error}"
                );
            }
        }
    }
}

/// Of everything that bodies are computed from, besides what the fingerprint stands for: should it ever leave something out that
/// moves a contact point or changes a constraint, the file is still not taken.
fn key(context: &Context<'_>, fingerprint: u64) -> u64 {
    let mut hash = Fnv(fingerprint);
    let mut term = |node: NodeId, direction: usize, value: f64| {
        hash.bytes(&(node.0 << 2 | direction as u32).to_le_bytes());
        hash.bytes(&value.to_bits().to_le_bytes());
    };
    for point in context.points {
        for v in [point.normal, point.tangents[0], point.tangents[1]] {
            point.row(v, &mut term);
        }
    }
    for column in context.columns {
        // Between columns, and between their kinds.
        term(NodeId(0), 3, f64::from(u8::from(column.is_displacement())));
        column.entries().iter().for_each(|&(node, direction, value)| term(node, usize::from(direction), value));
    }
    for node in (0..context.local.len() as u32).map(NodeId) {
        for direction in (0..3).filter(|&d| !context.constraints.is_free(node, d)) {
            term(node, direction, 0.0);
            context.constraints.expand(node, direction, 1.0, &mut term);
        }
    }
    hash.0
}
