//! Every method against closed forms, its own limits and the promises all methods make.

mod explicit;
mod fixtures;
mod order;
mod table;
