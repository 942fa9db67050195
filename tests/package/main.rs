//! What holds of the package as a whole: its licences, pages, names and layers, and that no thread
//! waits in vain.

mod calls;
mod circles;
mod features;
mod layers;
mod licences;
mod links;
mod public_names;
mod reading_lists;
mod release;
mod sources;
mod threads;
