//! Elimination order of a body: interior nodes by nested dissection, retained nodes last.

use feral_scotch::{CscPattern, scotch_order};

use super::numbering::NodeGraph;

/// Nodes in elimination order. The interior comes first, in a postorder of its elimination tree, so that columns
/// of one supernode stand together; the retained nodes follow in the given order.
pub fn order(graph: &NodeGraph, retained: &[u32]) -> Vec<u32> {
    let n = graph.len();
    let mut interior_of = vec![0u32; n];
    for &r in retained {
        interior_of[r as usize] = u32::MAX;
    }
    let interior: Vec<u32> = (0..n as u32).filter(|&i| interior_of[i as usize] != u32::MAX).collect();
    for (position, &node) in interior.iter().enumerate() {
        interior_of[node as usize] = position as u32;
    }
    let mut starts = vec![0i32];
    let mut neighbours = Vec::new();
    for &node in &interior {
        neighbours.extend(
            graph
                .of(node as usize)
                .iter()
                .map(|&j| interior_of[j as usize])
                .filter(|&j| j != u32::MAX)
                .map(|j| j as i32),
        );
        starts.push(neighbours.len() as i32);
    }
    let dissected = dissect(interior.len(), &starts, &neighbours);
    let ordered = postorder(&dissected, &starts, &neighbours);
    ordered.into_iter().map(|i| interior[i as usize]).chain(retained.iter().copied()).collect()
}

/// New-to-old permutation by nested dissection.
fn dissect(n: usize, starts: &[i32], neighbours: &[i32]) -> Vec<u32> {
    let pattern = CscPattern::new(n, starts, neighbours).expect("a symmetric graph without self loops, built above");
    match scotch_order(&pattern) {
        Ok(order) => order.into_iter().map(|i| i as u32).collect(),
        Err(error) => {
            // Any order is correct, only slower: say so and go on.
            tracing::warn!(%error, nodes = n, "nested dissection failed; eliminating in the order of the mesh");
            (0..n as u32).collect()
        }
    }
}

/// Renumbers within the given elimination order so that each subtree of the elimination tree is contiguous.
/// The fill does not change.
fn postorder(order: &[u32], starts: &[i32], neighbours: &[i32]) -> Vec<u32> {
    let n = order.len();
    let mut position = vec![0u32; n];
    for (p, &node) in order.iter().enumerate() {
        position[node as usize] = p as u32;
    }
    const NONE: u32 = u32::MAX;
    let (mut parent, mut ancestor) = (vec![NONE; n], vec![NONE; n]);
    for i in 0..n {
        let node = order[i] as usize;
        for &neighbour in &neighbours[starts[node] as usize..starts[node + 1] as usize] {
            let mut j = position[neighbour as usize];
            while j != NONE && (j as usize) < i {
                let next = ancestor[j as usize];
                ancestor[j as usize] = i as u32;
                if next == NONE {
                    parent[j as usize] = i as u32;
                }
                j = next;
            }
        }
    }
    let (mut child, mut sibling) = (vec![NONE; n], vec![NONE; n]);
    let mut roots = Vec::new();
    for i in (0..n).rev() {
        match parent[i] {
            NONE => roots.push(i as u32),
            p => {
                sibling[i] = child[p as usize];
                child[p as usize] = i as u32;
            }
        }
    }
    let mut out = Vec::with_capacity(n);
    let mut stack = roots;
    while let Some(&top) = stack.last() {
        match child[top as usize] {
            NONE => {
                out.push(order[top as usize]);
                stack.pop();
            }
            c => {
                child[top as usize] = sibling[c as usize];
                stack.push(c);
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(n: u32) -> NodeGraph {
        let mut starts = vec![0];
        let mut neighbours = Vec::new();
        for i in 0..n {
            neighbours.extend(i.checked_sub(1));
            neighbours.extend(Some(i + 1).filter(|&j| j < n));
            starts.push(neighbours.len() as u32);
        }
        NodeGraph { starts, neighbours }
    }

    #[test]
    fn every_node_is_eliminated_once_and_the_retained_ones_last() {
        let order = order(&path(50), &[7, 3]);
        assert_eq!(&order[48..], &[7, 3]);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert_eq!(sorted, (0..50).collect::<Vec<u32>>());
    }

    #[test]
    fn a_body_without_interior_is_its_retained_nodes() {
        assert_eq!(order(&path(3), &[0, 1, 2]), vec![0, 1, 2]);
    }

    #[test]
    fn postorder_keeps_children_before_their_parents() {
        let graph = path(40);
        let starts: Vec<i32> = graph.starts.iter().map(|&s| s as i32).collect();
        let neighbours: Vec<i32> = graph.neighbours.iter().map(|&s| s as i32).collect();
        let out = postorder(&(0..40).collect::<Vec<u32>>(), &starts, &neighbours);
        assert_eq!(out, (0..40).collect::<Vec<u32>>());
    }
}
