//! What static steps need: bodies factored once and condensed onto their contact points.

use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Place};
use crate::examination;
use crate::kept::{Kept, Prepared};
use crate::simulation::{Phase, PrepareOptions};
use crate::solve::bodies::{choose_path, prepare_bodies};
use crate::solve::body::{Body, BodyError};
use crate::solve::budget::Shortage;
use crate::solve::condensed::Condensed;
use crate::solve::contact::{ContactSystem, Structure, initial_springs};
use crate::solve::context::Context;
use crate::solve::floating::Floating;
use crate::solve::loose::Loose;
use crate::solve::motions::Motions;
use crate::solve::numbering::Bodies;
use crate::solve::sparse::SparseStructure;

/// Bodies factored and condensed onto their contact points. Immutable.
pub struct Statics {
    pub(crate) bodies: Arc<Vec<Body>>,
    pub(crate) condensed: Condensed,
    pub(crate) contact: ContactSystem,
    pub(crate) loose: Loose,
}

/// What the examination has found about bodies, rows and columns.
pub struct Setting<'a> {
    /// Connected bodies.
    pub bodies: &'a Bodies,
    /// Motions of each body that its supports leave free.
    pub motions: &'a [Motions],
    /// The same at the contact points.
    pub floating: &'a Floating,
    /// Number of contact rows.
    pub rows: usize,
    /// Columns that carry loads.
    pub real_columns: usize,
    /// First column of the motions that nothing resists.
    pub first_loose: usize,
}

impl Statics {
    /// Factors and condenses the bodies, or takes them from disk. Errors: a body that does not fit into memory, a direction without stiffness.
    pub fn prepare(
        context: &Context<'_>,
        setting: &Setting<'_>,
        options: &PrepareOptions,
        fingerprint: u64,
        announce: &mut dyn FnMut(Phase),
    ) -> Result<Self, Vec<Diagnostic>> {
        let &Setting { bodies, motions, floating, rows, real_columns, first_loose } = setting;
        let (budget, columns) = (context.budget, context.columns);
        let (condense, coupled) = choose_path(context, options.path, bodies, motions, floating);
        if let Some(coupled) = &coupled
            && let Err(shortage) = budget.take(coupled.numbers())
        {
            return Err(vec![too_large(&shortage, "the sparse system")]);
        }
        if options.cache.is_some() && !condense {
            tracing::warn!("the model takes the sparse path, so it is neither taken from disk nor kept there");
        }
        let kept = options.cache.as_ref().filter(|_| condense).map(|cache| Kept::new(cache, context, fingerprint));
        let stored = kept.as_ref().and_then(|kept| {
            announce(Phase::Cache);
            kept.load(context, bodies)
        });
        let (mut prepared, contributions) = match stored {
            Some((stored, numbers)) => {
                budget.take(numbers).map_err(|shortage| vec![too_large(&shortage, "the prepared model")])?;
                stored
            }
            None => {
                let computed = compute(context, bodies, motions, options.threads, condense, announce)?;
                if let Some(kept) = &kept {
                    announce(Phase::Cache);
                    kept.store(&computed);
                }
                computed
            }
        };
        announce(Phase::Condense);
        let loads = floating.loads(columns, bodies, motions);
        let (condensed, compliance) =
            Condensed::new(context, bodies, &prepared, &contributions, floating, loads, condense);
        for body in &mut prepared {
            body.keep_columns(real_columns);
        }
        let loose = Loose::new(&floating.loose, first_loose, &condensed);
        let prepared = Arc::new(prepared);
        let structure = match coupled {
            None => Structure::Dense(compliance),
            Some(coupled) => {
                let own = coupled.own_compliances();
                Structure::Sparse(Box::new(SparseStructure { bodies: prepared.clone(), coupled, own }))
            }
        };
        let contact = ContactSystem {
            extent: context.model.mesh.nodes.iter().flatten().fold(0.0, |m, x| x.abs().max(m)),
            springs: initial_springs(&structure, &floating.gaps),
            gap_motions: floating.gaps.clone(),
            resisted: floating.resisted.clone(),
            loose: floating.loose.clone(),
            structure,
            count: rows,
            behaviors: context.model.interactions.iter().map(|i| i.normal.clone()).collect(),
        };
        tracing::debug!(
            bodies = prepared.len(),
            unknowns = prepared.iter().map(|b| b.count).sum::<usize>(),
            factor = prepared.iter().filter_map(Body::factor_in_memory).map(|f| f.size().values).sum::<usize>(),
            contact_points = context.points.len(),
            "prepared"
        );
        Ok(Self { bodies: prepared, condensed, contact, loose })
    }
}

/// Computes the bodies; the errors are all there are.
fn compute(
    context: &Context<'_>,
    bodies: &Bodies,
    motions: &[Motions],
    threads: usize,
    condense: bool,
    announce: &mut dyn FnMut(Phase),
) -> Result<Prepared, Vec<Diagnostic>> {
    let (mut prepared, mut contributions, mut errors) = (Vec::new(), Vec::new(), Vec::new());
    let results = prepare_bodies(context, bodies, motions, threads, condense, announce);
    for (b, result) in results.into_iter().enumerate() {
        match result {
            Ok((body, contribution)) => {
                prepared.push(body);
                contributions.push(contribution);
            }
            Err(BodyError::NoStiffness { node, direction }) => errors.push(Diagnostic::error(
                Place::nowhere(),
                "",
                format!(
                    "node {} has no stiffness in direction {}: part of its body can move without resistance",
                    context.model.mesh.node_labels[node.index()],
                    direction + 1
                ),
                "connect it by whole faces, or hold it by *BOUNDARY",
            )),
            Err(BodyError::Memory(shortage)) => {
                let name = examination::body_name(context.model, &bodies.nodes[b], &bodies.elements[b]);
                errors.push(too_large(&shortage, &name));
            }
        }
    }
    if errors.is_empty() { Ok((prepared, contributions)) } else { Err(errors) }
}

/// A model that does not fit into memory.
fn too_large(shortage: &Shortage, what: &str) -> Diagnostic {
    Diagnostic::error(
        Place::nowhere(),
        "",
        shortage.describe(what),
        "use a coarser mesh away from contact, a machine with more memory, or another path (dense needs the square of the contact points)",
    )
}
