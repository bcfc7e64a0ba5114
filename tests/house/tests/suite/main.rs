//! All tests over the public interface, in one program: `cargo test -p toile-house --test suite NAME::` runs those of one file.

mod circles;
mod comments;
mod field_names;
mod files;
mod formats;
mod house_rules;
mod tokens;
