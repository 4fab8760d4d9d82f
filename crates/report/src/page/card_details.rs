//! The size limit of a page, and how it is shared among the cards of the scenes.
use super::{Card, script};

/// The maximum size of a page, in bytes. Pages are sent by mail, and opened on old machines.
pub const PAGE_BUDGET: usize = 2_950_000;

/// The maximum number of bytes on a page for the output of programs, in all scenes together.
pub(super) const OUTPUT_BUDGET: usize = 200_000;

/// The part of the size limit that pictures and tables may use before the first motion gets space.
const PICTURE_BUDGET: usize = PAGE_BUDGET / 3 * 2;

/// The part of a scene's card that fits on the page. Each level includes the lower ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CardDetail {
    /// Only the text fits.
    Words,
    /// The text and the pictures fit.
    Pictures,
    /// The text, the pictures and the rounded motion fit.
    Rounded,
    /// The text, the pictures and the exact motion fit.
    Exact,
}

/// Decides for each card how much of it the page contains. Text is always included. Pictures are added in the order of
/// the cards, then rounded motions, and then exact motions, again in the order of the cards.
pub(super) fn distribute<'a>(cards: impl Iterator<Item = Option<&'a Card>> + Clone) -> Vec<CardDetail> {
    let count = cards.clone().count();
    let mut rooms = vec![CardDetail::Words; count];
    let mut left = PAGE_BUDGET - 2 * script().len() - OUTPUT_BUDGET - 1_000 * count.min(1_000);
    let mut still = PICTURE_BUDGET.min(left);
    for (card, room) in cards.clone().zip(&mut rooms) {
        let Some((html, _)) = card.map(Card::sizes) else { continue };
        if html <= still {
            (still, left, *room) = (still - html, left - html, CardDetail::Pictures);
        }
    }
    for (card, room) in cards.clone().zip(&mut rooms).filter(|(_, room)| **room != CardDetail::Words) {
        let Some(card) = card else { continue };
        let (size, how) = match card.rounded_size() {
            Some(size) => (size, CardDetail::Rounded),
            None => (card.sizes().1, CardDetail::Exact),
        };
        if size <= left {
            (left, *room) = (left - size, how);
        }
    }
    for (card, room) in cards.zip(&mut rooms).filter(|(_, room)| **room == CardDetail::Rounded) {
        let Some((size, rounded)) = card.and_then(|card| Some((card.sizes().1, card.rounded_size()?))) else {
            continue;
        };
        if size <= left + rounded {
            (left, *room) = (left + rounded - size, CardDetail::Exact);
        }
    }
    rooms
}

/// Describes which cards the page does not contain completely.
pub(super) fn describe_omitted<'a>(cards: impl Iterator<Item = Option<&'a Card>>, rooms: &[CardDetail]) -> String {
    let moving_cards = cards.zip(rooms).filter(|(card, _)| card.is_some_and(|card| card.sizes().1 > 0));
    let of: Vec<CardDetail> = moving_cards.map(|(_, room)| *room).collect();
    let without = of.iter().filter(|room| matches!(room, CardDetail::Words | CardDetail::Pictures)).count();
    let rounded = of.iter().filter(|room| **room == CardDetail::Rounded).count();
    let scenes = |count: usize| if count == 1 { "one scene has".to_owned() } else { format!("{count} scenes have") };
    let mut parts = Vec::new();
    if without > 0 {
        parts.push(format!("{} no motion on this page", scenes(without)));
    }
    if rounded > 0 {
        parts.push(format!("{} a rounded motion on this page", scenes(rounded)));
    }
    if parts.is_empty() {
        return String::new();
    }
    format!(
        "<p class=\"hint\">The page would grow beyond 3 MB: {}. At a terminal, \
         <code>grade --scene NAME --format html=FILE</code> makes a page of one scene.</p>\n",
        parts.join("; ")
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn card(html: usize, data: usize, rounded: usize) -> Card {
        let text = |length| "x".repeat(length);
        let kept = serde_json::json!({"html": text(html), "data": text(data), "rounded": text(rounded)});
        Card::from_stored(&kept.to_string()).expect("a card")
    }

    fn rooms(cards: &[Card]) -> (Vec<CardDetail>, String) {
        let all = || cards.iter().map(Some);
        let rooms = distribute(all());
        let text = describe_omitted(all(), &rooms);
        (rooms, text)
    }

    /// Tests that the last motions are rounded if exact ones do not fit on the page together; if even rounded ones do
    /// not fit, the page says so.
    #[test]
    fn motions_are_rounded_before_they_are_left_out() {
        let (all, says) = rooms(&vec![card(50_000, 500_000, 50_000); 3]);
        assert_eq!((&all[..], says.as_str()), (&[CardDetail::Exact; 3][..], ""));
        let (all, says) = rooms(&vec![card(50_000, 500_000, 50_000); 10]);
        let count = |room| all.iter().filter(|detail| **detail == room).count();
        assert!(
            count(CardDetail::Exact) > 0 && count(CardDetail::Rounded) > 0 && count(CardDetail::Pictures) == 0,
            "{all:?}"
        );
        assert_eq!(all[0], CardDetail::Exact);
        assert!(says.contains("scenes have a rounded motion") && !says.contains("no motion"), "{says}");
        let (all, says) = rooms(&vec![card(50_000, 500_000, 200_000); 30]);
        assert!(all.contains(&CardDetail::Rounded) && all.contains(&CardDetail::Pictures), "{all:?}");
        assert!(says.contains("scenes have no motion") && says.contains("rounded"), "{says}");
        let (all, _) = rooms(&vec![card(500_000, 10, 0); 30]);
        assert_eq!(all.iter().filter(|room| **room == CardDetail::Words).count(), 27);
    }
}
