//! All bodies of a model: which path they take, and their preparation.

use super::body::{Body, BodyContribution, BodyError, retained_nodes};
use super::budget::condensed_operations;
use super::context::Context;
use super::floating::Floating;
use super::motions::Motions;
use super::numbering::Bodies;
use super::sparse::Coupled;
use crate::contact::points::ContactPoint;
use crate::simulation::{PathChoice, Phase};

/// A prepared body, or why there is none.
pub type BodyResult = Result<(Body, BodyContribution), BodyError>;

/// Operations of condensing below which the other path is not even looked at: seconds.
const CONDENSED_CHEAP: f64 = 1e11;
/// Largest separators of nested dissection that go one after another.
const SEPARATORS: f64 = 3.0;
/// Factorisations that the sparse path is reckoned with: one for each set of closed points on the way to the solution.
const SPARSE_FACTORIZATIONS: f64 = 6.0;

/// Whether bodies are condensed; else the coupled system.
pub fn choose_path(
    context: &Context<'_>,
    path: PathChoice,
    bodies: &Bodies,
    motions: &[Motions],
    floating: &Floating,
) -> (bool, Option<Coupled>) {
    let of_body = |b: usize| {
        let points = points_of_body(context, bodies, b);
        condensed_operations(3 * retained_nodes(context, &bodies.nodes[b], &points).len(), points.len())
    };
    let operations: f64 = if path == PathChoice::Auto { (0..bodies.nodes.len()).map(of_body).sum() } else { 0.0 };
    let cheap = operations < CONDENSED_CHEAP || (0..bodies.nodes.len()).all(|b| is_bulky(context, bodies, b));
    if path == PathChoice::Dense || (path == PathChoice::Auto && cheap) {
        return (true, None);
    }
    let coupled = Coupled::new(context, bodies, motions, floating);
    let sparse = SPARSE_FACTORIZATIONS * coupled.operations();
    tracing::debug!(dense = operations, sparse, "operations of the two paths");
    if path == PathChoice::Auto && operations <= sparse { (true, None) } else { (false, Some(coupled)) }
}

/// Whether the nodes that contact reaches are no more than a cube of as many nodes has in its largest separators: then the
/// factorisation itself costs as much as condensing, on either path.
fn is_bulky(context: &Context<'_>, bodies: &Bodies, body: usize) -> bool {
    let nodes = &bodies.nodes[body];
    let points = points_of_body(context, bodies, body);
    retained_nodes(context, nodes, &points).len() as f64 <= SEPARATORS * (nodes.len() as f64).powf(2.0 / 3.0)
}

/// Contact points that reach free directions of a body.
pub fn points_of_body(context: &Context<'_>, bodies: &Bodies, body: usize) -> Vec<u32> {
    let touches = |p: &ContactPoint| {
        let mut any = false;
        p.row([1.0; 3], |node, direction, value| {
            if bodies.of_node[node.index()] == body as u32 {
                context.constraints.expand(node, direction, value, |n, d, _| any |= context.constraints.is_free(n, d));
            }
        });
        any
    };
    (0..context.points.len() as u32).filter(|&i| touches(&context.points[i as usize])).collect()
}

/// Prepares every body, several at a time if allowed. The results do not depend on how many.
pub fn prepare_bodies(
    context: &Context<'_>,
    bodies: &Bodies,
    motions: &[Motions],
    threads: usize,
    condense: bool,
    announce: &mut dyn FnMut(Phase),
) -> Vec<BodyResult> {
    let count = bodies.nodes.len();
    let points_of = |body: usize| points_of_body(context, bodies, body);
    if threads <= 1 || count <= 1 {
        return (0..count)
            .map(|b| {
                Body::prepare(
                    context,
                    &bodies.nodes[b],
                    &bodies.elements[b],
                    &motions[b],
                    points_of(b),
                    condense,
                    announce,
                )
            })
            .collect();
    }
    announce(Phase::Numeric);
    let next = std::sync::atomic::AtomicUsize::new(0);
    let results: Vec<std::sync::Mutex<Option<BodyResult>>> = (0..count).map(|_| std::sync::Mutex::new(None)).collect();
    std::thread::scope(|scope| {
        for _ in 0..threads.min(count) {
            scope.spawn(|| {
                loop {
                    let b = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    if b >= count {
                        break;
                    }
                    let result = Body::prepare(
                        context,
                        &bodies.nodes[b],
                        &bodies.elements[b],
                        &motions[b],
                        points_of(b),
                        condense,
                        &mut |_| {},
                    );
                    *results[b].lock().expect("no other thread writes this slot") = Some(result);
                }
            });
        }
    });
    results
        .into_iter()
        .map(|slot| slot.into_inner().expect("a panic has ended the scope before").expect("every body was taken once"))
        .collect()
}
