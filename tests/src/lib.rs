//! Data-driven suite over the public interfaces, house rules.
