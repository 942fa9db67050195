//! What a user meets first: the programs, and under which terms all of it may be used.

mod layers;
mod licences;
mod links;
mod my_robot;
mod programs;
mod public_names;
mod reading_lists;
mod sources;
mod threads;
