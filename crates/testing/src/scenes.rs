//! Scenes that tests of several crates simulate.

/// A scene with an edge that turns, and two discs that meet it and each other, above a slanted half-plane: `hybrid`,
/// with all kinds of pairs.
pub const ALL_KINDS: &str = "<scene><duration time=\"1\"/><integrator type=\"explicit-euler\" dt=\"0.1\"/>\
    <collision type=\"hybrid\" COR=\"0.8\" maxiters=\"2\"/>\
    <particle m=\"1\" px=\"-2\" py=\"0.1\" vx=\"3\" vy=\"0\" fixed=\"0\" radius=\"0.3\"/>\
    <particle m=\"2\" px=\"0\" py=\"-1\" vx=\"0.5\" vy=\"0\" fixed=\"0\" radius=\"0.25\"/>\
    <particle m=\"3\" px=\"0.5\" py=\"1\" vx=\"-0.25\" vy=\"0\" fixed=\"0\" radius=\"0.2\"/>\
    <particle m=\"1\" px=\"1\" py=\"-2\" vx=\"-3\" vy=\"-1\" fixed=\"0\" radius=\"0.2\"/>\
    <edge i=\"1\" j=\"2\" radius=\"0.15\"/><halfplane px=\"0\" py=\"-2.5\" nx=\"1\" ny=\"3\"/></scene>";
