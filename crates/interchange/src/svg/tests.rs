//! Drawings read, patterns written and read back.
