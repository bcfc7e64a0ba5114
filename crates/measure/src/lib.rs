//! Body measurements: names, values, asked or predicted.
