//! Runs the attack suite on the user's machine (follows).
