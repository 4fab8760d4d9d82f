//! Random secrets that cannot be guessed.

/// Returns 128 random bits in hexadecimal.
///
/// # Panics
///
/// Panics if the system provides no random numbers.
pub fn random_hex() -> String {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).expect("random numbers from the system");
    to_hex(&bytes)
}

/// Returns bytes in hexadecimal.
pub fn to_hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
