//! Size of a JSON text's objects, before Python makes them.

use crate::engine_call::EngineCall;
use crate::errors::PyFault;
use pyo3::prelude::*;

/// Returns the nesting depth of arrays and objects, and the largest number of values and names that the text can hold.
#[pyfunction]
pub(crate) fn json_size_bounds(py: Python<'_>, text: &[u8]) -> PyResult<(usize, usize)> {
    py.engine(|| Ok::<_, PyFault>(extent(text)))
}

fn extent(text: &[u8]) -> (usize, usize) {
    let (mut depth, mut deepest, mut values) = (0_usize, 0, 1);
    let (mut is_text, mut is_escaped) = (false, false);
    for byte in text {
        match byte {
            _ if is_escaped => is_escaped = false,
            b'\\' if is_text => is_escaped = true,
            b'"' => is_text = !is_text,
            _ if is_text => {}
            b'[' | b'{' => {
                depth += 1;
                deepest = deepest.max(depth);
                values += 1;
            }
            b']' | b'}' => depth = depth.saturating_sub(1),
            b',' | b':' => values += 1,
            _ => {}
        }
    }
    (deepest, values)
}
