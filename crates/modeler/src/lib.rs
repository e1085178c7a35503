//! The model and what can be done to it: commands, grabs, relaxation, undo.
