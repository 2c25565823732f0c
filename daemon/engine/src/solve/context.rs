//! What is known of a model when its bodies are prepared.

use super::budget::Budget;
use super::columns::Column;
use super::constraints::Constraints;
use crate::contact::points::ContactPoint;
use crate::element::Elasticity;
use crate::model::Model;

/// What is known of the model when bodies are prepared.
pub struct Context<'a> {
    /// The model.
    pub model: &'a Model,
    /// Elastic constants by material.
    pub elasticities: &'a [Elasticity],
    /// Prescribed and dependent directions.
    pub constraints: &'a Constraints,
    /// Body-local number of each node.
    pub local: &'a [u32],
    /// Memory that may be used.
    pub budget: &'a Budget,
    /// All contact points.
    pub points: &'a [ContactPoint],
    /// Load and displacement columns.
    pub columns: &'a [Column],
}
