//! Tests that belong to no crate: the rules of the workspace, and documents made from its data. The tests that a user would
//! recognise are in Python, beside this file.
