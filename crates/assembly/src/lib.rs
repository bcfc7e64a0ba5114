//! Draft to seam-matched, triangulated, placed panels.
