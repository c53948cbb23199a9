//! The JSON of `cellcaster snapshot --format json`.

use ratatui::style::Color;
use serde::Deserialize;

use super::{CellGrid, GridError};
use crate::color::Rgb;
use crate::tui::canvas::true_color;

#[derive(Deserialize)]
struct JsonGrid {
    cols: u16,
    rows: u16,
    cells: Vec<Vec<JsonCell>>,
}

#[derive(Deserialize)]
struct JsonCell {
    ch: String,
    fg: Option<String>,
    bg: Option<String>,
}

impl CellGrid {
    /// Reads the output of `cellcaster snapshot --format json`.
    ///
    /// # Errors
    /// If `text` is not such an output.
    pub fn from_json(text: &str) -> Result<Self, GridError> {
        let json: JsonGrid = serde_json::from_str(text)
            .map_err(|error| GridError::new(format!("is not the JSON of a snapshot: {error}")))?;
        let mut grid = Self::blank(json.cols, json.rows)?;
        let is_whole = json.cells.len() == usize::from(json.rows)
            && json.cells.iter().all(|row| row.len() == usize::from(json.cols));
        if !is_whole {
            return Err(GridError::new(format!("does not have {}x{} cells", json.cols, json.rows)));
        }
        for (cell, JsonCell { ch, fg, bg }) in
            grid.0.content.iter_mut().zip(json.cells.into_iter().flatten())
        {
            cell.set_symbol(&ch).set_fg(color(fg.as_deref())?).set_bg(color(bg.as_deref())?);
        }
        Ok(grid)
    }
}

fn color(text: Option<&str>) -> Result<Color, GridError> {
    let Some(text) = text else { return Ok(Color::Reset) };
    let color = text.parse::<Rgb>().map(true_color);
    color.map_err(|_| GridError::new(format!("has the colour {text:?}, which is not #rrggbb")))
}
