//! Positions and directions: lists of three numbers.

use glam::DVec3;
use toml::de::DeValue;

use super::coordinates;
use crate::fault::document::Entry;
use crate::fault::{Fault, quoted};
use crate::space::FARTHEST;

/// Reads the position in `entry`, within the limits of bodies and cameras.
pub(crate) fn place(entry: &Entry<'_, '_>) -> Option<DVec3> {
    let place = three(entry, &format!("{} = [2, 0, 0.5]", entry.key))?;
    if place.abs().max_element() <= FARTHEST {
        return Some(place);
    }
    let message = format!("the coordinates of {} must be {}", quoted(entry.key), coordinates());
    entry.faults.push(Fault::new(entry.value_place.clone(), message).label("this is too far away"));
    None
}

/// Reads the direction in `entry`, of any length.
pub(crate) fn direction(entry: &Entry<'_, '_>, example: &str) -> Option<DVec3> {
    let direction = three(entry, example)?;
    if direction.abs().max_element() > 0.0 {
        return Some(direction);
    }
    let message = format!("{} points nowhere", quoted(entry.key));
    let fault = Fault::new(entry.value_place.clone(), message).label("all three are zero");
    entry.faults.push(fault.help(format!("write {example}")));
    None
}

/// Three finite numbers.
fn three(entry: &Entry<'_, '_>, example: &str) -> Option<DVec3> {
    let DeValue::Array(list) = entry.value else {
        entry.faults.push(entry.wrong_type("a list of three numbers", example));
        return None;
    };
    let numbers = list.iter().map(|value| {
        let number = Entry {
            key: entry.key,
            key_place: entry.key_place.clone(),
            value: value.get_ref(),
            value_place: value.span(),
            faults: entry.faults,
        };
        number.number().filter(|number| number.is_finite())
    });
    let numbers: Option<Vec<f64>> = numbers.collect();
    if let Some(&[x, y, z]) = numbers.as_deref() {
        return Some(DVec3::new(x, y, z));
    }
    let message = format!("{} must be a list of three finite numbers", quoted(entry.key));
    let fault = Fault::new(entry.value_place.clone(), message);
    entry.faults.push(
        fault.label("to the east, to the south, and upwards").help(format!("write {example}")),
    );
    None
}
