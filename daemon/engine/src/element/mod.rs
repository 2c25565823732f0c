//! Elements: stiffness, stresses, faces. Pure functions of coordinates; nothing of the model is known here
//! but the kind of an element.

pub mod brick;
pub mod quad;
