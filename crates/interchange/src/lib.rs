//! Native formats, importers, exporters.
