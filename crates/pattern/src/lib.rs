//! The pattern document: panels, seams, formulas, edits, diagnostics.
