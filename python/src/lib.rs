//! The native part of the Python module `fosssim` (`fosssim/__init__.py` has the public interface). Numbers are passed
//! as bytes in the machine's order, which NumPy reads without a copy.
use fosssim_browser::{PageHost, PageSession, parts};
use fosssim_model::{
    scene::{self, LoadedScene, Scene},
    trace::{Frame, Layout, PolynomialLabel, Reader, collect_labels},
};
use fosssim_num::vector::Vec2;
use fosssim_report::scene_problems;
use pyo3::{exceptions::PyValueError, prelude::*, pybacked::PyBackedBytes, types::PyBytes};

/// A trace in memory, which is the only file of a request.
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

/// Returns doubles as bytes.
fn pack_numbers<'py>(py: Python<'py>, numbers: &[f64]) -> PyResult<Bound<'py, PyBytes>> {
    PyBytes::new_with(py, 8 * numbers.len(), |into| {
        for (bytes, number) in into.chunks_exact_mut(8).zip(numbers) {
            bytes.copy_from_slice(&number.to_ne_bytes());
        }
        Ok(())
    })
}

fn read_scene(name: &str, xml: &[u8]) -> PyResult<Scene> {
    match scene::read(name, xml) {
        Ok(LoadedScene { scene, .. }) => Ok(scene),
        Err(refused) => Err(PyValueError::new_err(scene_problems::render_errors(name, xml, &refused))),
    }
}

#[pymodule]
mod _native {
    use super::*;

    /// A session of requests that are answered one after the other.
    #[pyclass]
    #[derive(Default)]
    struct Session(PageSession);

    #[pymethods]
    impl Session {
        #[new]
        fn new() -> Self {
            Self::default()
        }

        /// Answers a request about a trace. Request and answer are lists of byte strings, the first of which is JSON.
        fn ask<'py>(
            &mut self,
            py: Python<'py>,
            request: Vec<PyBackedBytes>,
            trace: PyBackedBytes,
        ) -> PyResult<Vec<Bound<'py, PyBytes>>> {
            let joined = parts::join_parts(&request.iter().map(|part| &part[..]).collect::<Vec<_>>());
            let answer = py.detach(|| self.0.answer(&joined, &Memory(&trace)));
            let parts = parts::split(&answer).ok_or_else(|| PyValueError::new_err("the answer is incomplete"))?;
            Ok(parts.iter().map(|part| PyBytes::new(py, part)).collect())
        }
    }

    /// Returns the positions and velocities of all readable records, and the reason why no more can be read.
    #[pyfunction]
    fn states<'py>(
        py: Python<'py>,
        name: &str,
        xml: PyBackedBytes,
        trace: PyBackedBytes,
    ) -> PyResult<(Bound<'py, PyBytes>, Bound<'py, PyBytes>, Option<String>)> {
        let scene = read_scene(name, &xml)?;
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
        Ok((pack_numbers(py, &positions)?, pack_numbers(py, &velocities)?, fault))
    }

    /// Returns the logs of all readable records: impulses, polynomials and coefficients, each packed as in
    /// `fosssim/__init__.py`.
    #[pyfunction]
    fn logs<'py>(
        py: Python<'py>,
        name: &str,
        xml: PyBackedBytes,
        trace: PyBackedBytes,
    ) -> PyResult<[Bound<'py, PyBytes>; 3]> {
        let scene = read_scene(name, &xml)?;
        let [impulses, polynomials, coefficients] = py.detach(|| {
            let layout = Layout::for_scene(&scene);
            let mut reader = Reader::from_slice(&trace, layout);
            let (mut frame, mut record, mut before) = (Frame::default(), 0_u64, None);
            let (mut impulses, mut polynomials, mut coefficients) = (Vec::new(), Vec::new(), Vec::new());
            // The labels of the record's step.
            let mut step_labels: Vec<PolynomialLabel> = Vec::new();
            while let Ok(true) = reader.next(&mut frame) {
                let position = [record.to_ne_bytes(), u64::from(layout.step_of_record(record)).to_ne_bytes()].concat();
                for impulse in &frame.impulses {
                    impulses.extend_from_slice(&position);
                    impulses.extend([impulse.kind, impulse.first, impulse.second].map(i32::to_ne_bytes).as_flattened());
                    let numbers = [impulse.normal.x, impulse.normal.y, impulse.time];
                    impulses.extend(numbers.map(f64::to_ne_bytes).as_flattened());
                }
                if let Some(before) = before.take() {
                    step_labels = collect_labels(&scene, &before);
                }
                let is_known = step_labels.len() >= frame.polynomials.len();
                for (number, numbers) in frame.polynomials.iter().enumerate() {
                    let label = step_labels.get(number).filter(|_| is_known);
                    let label = label.map_or([-1; 4], |PolynomialLabel { pair, number, .. }| {
                        [pair.kind.code(), pair.first as i32, pair.second as i32, *number as i32]
                    });
                    polynomials.extend_from_slice(&position);
                    polynomials.extend(label.map(i32::to_ne_bytes).as_flattened());
                    let ends = [coefficients.len() / 8, numbers.len()].map(|count| (count as u64).to_ne_bytes());
                    polynomials.extend(ends.as_flattened());
                    coefficients.extend(numbers.iter().flat_map(|number| number.to_ne_bytes()));
                }
                if layout.has_polynomials && !layout.is_mid_record(record) {
                    before = Some(frame.state.clone());
                }
                record += 1;
            }
            [impulses, polynomials, coefficients]
        });
        Ok([&impulses, &polynomials, &coefficients].map(|packed| PyBytes::new(py, packed)))
    }

    /// Returns the contents of a scene: duration, time step, steps, records per step; positions, velocities, masses and
    /// radii of particles as doubles; a byte for each particle, whether it is fixed; the ends of edges as pairs.
    #[pyfunction]
    #[expect(clippy::type_complexity, reason = "a tuple that Python names")]
    fn scene<'py>(
        py: Python<'py>,
        name: &str,
        xml: PyBackedBytes,
    ) -> PyResult<((f64, f64, u32, u32), [Bound<'py, PyBytes>; 4], Bound<'py, PyBytes>, Vec<(usize, usize)>)> {
        let scene = read_scene(name, &xml)?;
        let particles = &scene.particles;
        let components = |vector: Vec2| [vector.x, vector.y];
        let pack = |numbers: Vec<f64>| pack_numbers(py, &numbers);
        let numbers = [
            pack(particles.iter().flat_map(|particle| components(particle.position)).collect())?,
            pack(particles.iter().flat_map(|particle| components(particle.velocity)).collect())?,
            pack(particles.iter().map(|particle| particle.mass).collect())?,
            pack(particles.iter().map(|particle| particle.radius).collect())?,
        ];
        let fixed: Vec<u8> = particles.iter().map(|particle| u8::from(particle.fixed)).collect();
        let edges = scene.edges.iter().map(|edge| (edge.first, edge.second)).collect();
        let per_step = Layout::for_scene(&scene).records_per_step();
        let times = (scene.duration, scene.time_step, scene.step_count(), per_step);
        Ok((times, numbers, PyBytes::new(py, &fixed), edges))
    }
}
