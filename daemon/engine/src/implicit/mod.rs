//! Implicit dynamics: matrices of the time operator, factored once per increment size.

mod hht;
mod model;
mod operator;

pub use hht::Hht;
pub use model::ImplicitModel;
pub use operator::{Operator, Operators};
