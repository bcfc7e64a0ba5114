//! Scene, model, state, methods, contact, elastics, merging.
