//! Every method against closed forms, its own limits and the promises all methods make.

mod contact;
mod explicit;
mod fixtures;
mod hard;
mod order;
mod patches;
mod rest;
mod table;
