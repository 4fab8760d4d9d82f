//! The native part of the Python module `fosssim` (`fosssim/__init__.py` has the surface that people use). Numbers
//! go over as bytes in the machine's order, which NumPy reads where they lie.
use fosssim_browser::{PageHost, PageSession, parts};
use fosssim_model::{
    scene::{self, LoadedScene, Scene},
    trace::{Frame, Layout, Reader},
};
use fosssim_num::vector::Vec2;
use fosssim_report::problems;
use pyo3::{exceptions::PyValueError, prelude::*, pybacked::PyBackedBytes, types::PyBytes};

/// A trace in memory, the only file of a request.
struct Memory<'a>(&'a [u8]);

impl PageHost for Memory<'_> {
    fn read(&self, file: u32, offset: u64, into: &mut [u8]) -> Option<usize> {
        let rest = usize::try_from(offset).ok().and_then(|offset| self.0.get(offset..)).filter(|_| file == 0)?;
        let count = rest.len().min(into.len());
        into[..count].copy_from_slice(&rest[..count]);
        Some(count)
    }

    fn progress(&self, _: u32, _: u32) {}
}

/// Doubles as bytes.
fn bytes<'py>(py: Python<'py>, numbers: &[f64]) -> PyResult<Bound<'py, PyBytes>> {
    PyBytes::new_with(py, 8 * numbers.len(), |into| {
        for (place, number) in into.chunks_exact_mut(8).zip(numbers) {
            place.copy_from_slice(&number.to_ne_bytes());
        }
        Ok(())
    })
}

fn read(name: &str, xml: &[u8]) -> PyResult<Scene> {
    match scene::read(name, xml) {
        Ok(LoadedScene { scene, .. }) => Ok(scene),
        Err(refused) => Err(PyValueError::new_err(problems::errors(name, xml, &refused))),
    }
}

#[pymodule]
mod _native {
    use super::*;

    /// Answers requests in their order, each a list of byte strings of which the first is JSON; so is each answer.
    #[pyfunction]
    fn ask<'py>(
        py: Python<'py>,
        requests: Vec<Vec<PyBackedBytes>>,
        trace: PyBackedBytes,
    ) -> PyResult<Vec<Vec<Bound<'py, PyBytes>>>> {
        let joined: Vec<Vec<u8>> = requests
            .iter()
            .map(|request| parts::joined(&request.iter().map(|part| &part[..]).collect::<Vec<_>>()))
            .collect();
        let answers: Vec<Vec<u8>> = py.detach(|| {
            let (mut session, host) = (PageSession::default(), Memory(&trace));
            joined.iter().map(|request| session.answer(request, &host)).collect()
        });
        let cut = || PyValueError::new_err("the answer is cut");
        answers
            .iter()
            .map(|answer| Ok(parts::split(answer).ok_or_else(cut)?.iter().map(|part| PyBytes::new(py, part)).collect()))
            .collect()
    }

    /// Positions and velocities of all records that can be read, and why no more can.
    #[pyfunction]
    fn states<'py>(
        py: Python<'py>,
        name: &str,
        xml: PyBackedBytes,
        trace: PyBackedBytes,
    ) -> PyResult<(Bound<'py, PyBytes>, Bound<'py, PyBytes>, Option<String>)> {
        let scene = read(name, &xml)?;
        let (positions, velocities, fault) = py.detach(|| {
            let mut reader = Reader::from_slice(&trace, Layout::for_scene(&scene));
            let (mut frame, mut positions, mut velocities) = (Frame::default(), Vec::new(), Vec::new());
            let fault = loop {
                match reader.next(&mut frame) {
                    Ok(true) => {
                        positions.extend_from_slice(&frame.state.positions);
                        velocities.extend_from_slice(&frame.state.velocities);
                    }
                    Ok(false) => break None,
                    Err(error) => break Some(error.to_string()),
                }
            };
            (positions, velocities, fault)
        });
        Ok((bytes(py, &positions)?, bytes(py, &velocities)?, fault))
    }

    /// Returns the contents of a scene: duration, time step, steps; positions, velocities, masses and radii of
    /// particles as doubles; whether each is fixed, a byte each; the ends of edges as pairs.
    #[pyfunction]
    #[expect(clippy::type_complexity, reason = "a tuple that Python names")]
    fn scene<'py>(
        py: Python<'py>,
        name: &str,
        xml: PyBackedBytes,
    ) -> PyResult<((f64, f64, u32), [Bound<'py, PyBytes>; 4], Bound<'py, PyBytes>, Vec<(usize, usize)>)> {
        let scene = read(name, &xml)?;
        let particles = &scene.particles;
        let both = |vector: Vec2| [vector.x, vector.y];
        let of = |numbers: Vec<f64>| bytes(py, &numbers);
        let numbers = [
            of(particles.iter().flat_map(|particle| both(particle.position)).collect())?,
            of(particles.iter().flat_map(|particle| both(particle.velocity)).collect())?,
            of(particles.iter().map(|particle| particle.mass).collect())?,
            of(particles.iter().map(|particle| particle.radius).collect())?,
        ];
        let fixed: Vec<u8> = particles.iter().map(|particle| u8::from(particle.fixed)).collect();
        let edges = scene.edges.iter().map(|edge| (edge.first, edge.second)).collect();
        let times = (scene.duration, scene.time_step, scene.steps());
        Ok((times, numbers, PyBytes::new(py, &fixed), edges))
    }
}
