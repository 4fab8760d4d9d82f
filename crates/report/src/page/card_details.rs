//! The size limit of a page, and how it is shared among the cards of the scenes.
use super::{Card, script};

/// The maximum size of a page, in bytes. Pages are sent by mail, and opened on old machines.
pub const PAGE_BUDGET: usize = 2_950_000;

/// The maximum number of bytes on a page for the programs' output, in all scenes together.
pub(super) const OUTPUT_BUDGET: usize = 200_000;

/// The part of the size limit that pictures and tables may use before the first motion gets space.
const PICTURE_BUDGET: usize = PAGE_BUDGET / 3 * 2;

/// The part of a scene's card that fits on the page. Each level includes the lower ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CardDetail {
    /// Only the text fits.
    Text,
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
    let mut details = vec![CardDetail::Text; count];
    let mut bytes_left = PAGE_BUDGET - 2 * script().len() - OUTPUT_BUDGET - 1_000 * count.min(1_000);
    let mut picture_bytes_left = PICTURE_BUDGET.min(bytes_left);
    for (card, detail) in cards.clone().zip(&mut details) {
        let Some((html, _)) = card.map(Card::sizes) else { continue };
        if html <= picture_bytes_left {
            (picture_bytes_left, bytes_left, *detail) =
                (picture_bytes_left - html, bytes_left - html, CardDetail::Pictures);
        }
    }
    for (card, detail) in cards.clone().zip(&mut details).filter(|(_, detail)| **detail != CardDetail::Text) {
        let Some(card) = card else { continue };
        let (size, how) = match card.rounded_size() {
            Some(size) => (size, CardDetail::Rounded),
            None => (card.sizes().1, CardDetail::Exact),
        };
        if size <= bytes_left {
            (bytes_left, *detail) = (bytes_left - size, how);
        }
    }
    for (card, detail) in cards.zip(&mut details).filter(|(_, detail)| **detail == CardDetail::Rounded) {
        let Some((size, rounded)) = card.and_then(|card| Some((card.sizes().1, card.rounded_size()?))) else {
            continue;
        };
        if size <= bytes_left + rounded {
            (bytes_left, *detail) = (bytes_left + rounded - size, CardDetail::Exact);
        }
    }
    details
}

/// Describes which cards the page does not contain completely.
pub(super) fn describe_reduced_cards<'a>(
    cards: impl Iterator<Item = Option<&'a Card>>,
    details: &[CardDetail],
) -> String {
    let moving_cards = cards.zip(details).filter(|(card, _)| card.is_some_and(|card| card.sizes().1 > 0));
    let moving_details: Vec<CardDetail> = moving_cards.map(|(_, detail)| *detail).collect();
    let without =
        moving_details.iter().filter(|detail| matches!(detail, CardDetail::Text | CardDetail::Pictures)).count();
    let rounded_count = moving_details.iter().filter(|detail| **detail == CardDetail::Rounded).count();
    let scenes = |count: usize| if count == 1 { "one scene has".to_owned() } else { format!("{count} scenes have") };
    let mut parts = Vec::new();
    if without > 0 {
        parts.push(format!("{} no motion on this page", scenes(without)));
    }
    if rounded_count > 0 {
        parts.push(format!("{} a rounded motion on this page", scenes(rounded_count)));
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

    fn distribute_all(cards: &[Card]) -> (Vec<CardDetail>, String) {
        let all = || cards.iter().map(Some);
        let details = distribute(all());
        let text = describe_reduced_cards(all(), &details);
        (details, text)
    }

    /// Tests that the last motions are rounded if exact ones do not fit on the page together; if even rounded ones do
    /// not fit, the page says so.
    #[test]
    fn motions_are_rounded_before_they_are_left_out() {
        let (all, text) = distribute_all(&vec![card(50_000, 500_000, 50_000); 3]);
        assert_eq!((&all[..], text.as_str()), (&[CardDetail::Exact; 3][..], ""));
        let (all, text) = distribute_all(&vec![card(50_000, 500_000, 50_000); 10]);
        let count = |expected| all.iter().filter(|detail| **detail == expected).count();
        assert!(
            count(CardDetail::Exact) > 0 && count(CardDetail::Rounded) > 0 && count(CardDetail::Pictures) == 0,
            "{all:?}"
        );
        assert_eq!(all[0], CardDetail::Exact);
        assert!(text.contains("scenes have a rounded motion") && !text.contains("no motion"), "{text}");
        let (all, text) = distribute_all(&vec![card(50_000, 500_000, 200_000); 30]);
        assert!(all.contains(&CardDetail::Rounded) && all.contains(&CardDetail::Pictures), "{all:?}");
        assert!(text.contains("scenes have no motion") && text.contains("rounded"), "{text}");
        let (all, _) = distribute_all(&vec![card(500_000, 10, 0); 30]);
        assert_eq!(all.iter().filter(|detail| **detail == CardDetail::Text).count(), 27);
    }
}
