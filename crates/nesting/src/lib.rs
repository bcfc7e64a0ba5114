//! Marker making on plain outlines.
