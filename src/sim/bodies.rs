//! The scene's constants as one array per attribute (filled by `Simulation::new`).
