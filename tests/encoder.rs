//! Encoders and their initialisers, each against its equation in Hoekstra et al.

#[path = "encoder/initialisers.rs"]
mod initialisers;
#[path = "encoder/maps.rs"]
mod maps;
#[path = "encoder/networks.rs"]
mod networks;
