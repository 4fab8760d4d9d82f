//! (interface; body follows)
