//! The dense matrix of the implicit integrators, and its blocks.

/// A 2x2 block, `[row][column]`.
pub(crate) type Block = [[f64; 2]; 2];

/// A square matrix of 2N rows, column-major.
#[derive(Debug, Clone)]
pub(crate) struct Matrix {
    size: usize,
    entries: Vec<f64>,
}

impl Matrix {
    /// The zero matrix for `particles` particles.
    pub fn new(particles: usize) -> Self {
        let size = 2 * particles;
        Self { size, entries: vec![0.0; size * size] }
    }

    /// Number of rows, 2N.
    pub fn size(&self) -> usize {
        self.size
    }

    /// All entries, column after column.
    pub fn entries_mut(&mut self) -> &mut [f64] {
        &mut self.entries
    }

    /// One entry.
    #[cfg(test)]
    pub fn get(&self, row: usize, column: usize) -> f64 {
        self.entries[column * self.size + row]
    }

    /// One entry, to be changed.
    pub fn get_mut(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.entries[column * self.size + row]
    }

    /// Adds `block` where the rows of particle `row` meet the columns of particle `column`.
    pub fn add_block(&mut self, row: usize, column: usize, block: &Block) {
        for (r, line) in block.iter().enumerate() {
            for (c, &value) in line.iter().enumerate() {
                *self.get_mut(2 * row + r, 2 * column + c) += value;
            }
        }
    }

    /// Subtracts `block` there.
    pub fn subtract_block(&mut self, row: usize, column: usize, block: &Block) {
        for (r, line) in block.iter().enumerate() {
            for (c, &value) in line.iter().enumerate() {
                *self.get_mut(2 * row + r, 2 * column + c) -= value;
            }
        }
    }

    /// All entries become zero.
    pub fn clear(&mut self) {
        self.entries.fill(0.0);
    }

    /// Every entry is multiplied by `h`.
    pub fn scale(&mut self, h: f64) {
        for entry in &mut self.entries {
            *entry *= h;
        }
    }
}
