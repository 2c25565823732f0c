//! Numbering and pattern of a body: what matrices of one pattern share.

use std::sync::OnceLock;

use super::body::retained_nodes;
use super::context::Context;
use super::linear::Symbolic;
use super::numbering::{NOT_FREE, NodeGraph, Reach};
use super::ordering;
use crate::model::NodeId;

/// How a body is numbered.
pub struct BodyPlan {
    /// Body-local nodes in elimination order.
    pub order: Vec<u32>,
    /// Unknown of each direction of each body-local node, or `NOT_FREE`.
    pub unknowns: Vec<[u32; 3]>,
    /// Number of unknowns.
    pub count: usize,
    /// Unknowns that no contact point touches; they come first.
    pub interior: usize,
    /// Contact points of the body.
    pub points: Vec<u32>,
    /// Whether it is condensed onto them.
    pub condense: bool,
    /// Pattern of the factor, found by the first matrix.
    pub symbolic: OnceLock<Symbolic>,
}

impl BodyPlan {
    /// Orders a body; `held` are body-local nodes and directions that are no unknowns.
    pub fn new(
        context: &Context<'_>,
        nodes: &[NodeId],
        elements: &[u32],
        held: &[(usize, usize)],
        points: Vec<u32>,
        condense: bool,
    ) -> Self {
        let mut unknowns = vec![[NOT_FREE; 3]; nodes.len()];
        let retained = if condense { retained_nodes(context, nodes, &points) } else { Vec::new() };
        let mut plan = Self {
            order: Vec::new(),
            unknowns: Vec::new(),
            count: 0,
            interior: 0,
            points,
            condense,
            symbolic: OnceLock::new(),
        };
        let reach = Reach::new(&context.model.mesh, elements, context.constraints);
        let order = ordering::order(&plan.graph(context, &reach, nodes, elements), &retained);
        let mut is_held = vec![0u8; nodes.len()];
        for &(node, direction) in held {
            is_held[node] |= 1 << direction;
        }
        for (position, &node) in order.iter().enumerate() {
            if position == order.len() - retained.len() {
                plan.interior = plan.count;
            }
            for direction in 0..3 {
                let free = context.constraints.is_free(nodes[node as usize], direction);
                if free && is_held[node as usize] & (1 << direction) == 0 {
                    unknowns[node as usize][direction] = plan.count as u32;
                    plan.count += 1;
                }
            }
        }
        if retained.is_empty() {
            plan.interior = plan.count;
        }
        (plan.order, plan.unknowns) = (order, unknowns);
        plan
    }

    /// Which nodes the matrix couples.
    pub fn graph(&self, context: &Context<'_>, reach: &Reach<'_>, nodes: &[NodeId], elements: &[u32]) -> NodeGraph {
        let coupling: Vec<u32> =
            elements.iter().copied().filter(|&e| context.couples(e) || reach.is_extended(e)).collect();
        NodeGraph::new(reach, nodes, &coupling, context.local)
    }
}
