//! Where a request comes from: the other end of its connection, or whom a proxy that is trusted says that it speaks
//! for.
use axum::http::{HeaderMap, HeaderName, header};
use ipnet::IpNet;
use std::{net::IpAddr, str::FromStr};

/// The address that a request comes from, as an extension of requests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ClientAddress(pub IpAddr);

/// Networks: addresses, or networks such as `10.0.0.0/8`, with commas between them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Networks(Vec<IpNet>);

impl FromStr for Networks {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let one = |word: &str| {
            let network = word.parse::<IpNet>().or_else(|_| word.parse::<IpAddr>().map(IpNet::from));
            network.map_err(|_| format!("{word} is neither an address nor a network such as 10.0.0.0/8"))
        };
        let words = text.split(',').map(str::trim).filter(|word| !word.is_empty());
        Ok(Self(words.map(one).collect::<Result<_, _>>()?))
    }
}

impl Networks {
    /// Whether an address lies in one of them.
    pub fn contains(&self, address: IpAddr) -> bool {
        self.0.iter().any(|network| network.contains(&address))
    }

    /// The asker, by a request's headers: the last address that none of these networks speaks for. An address before it
    /// may be anybody's invention.
    pub(super) fn client(&self, peer: IpAddr, headers: &HeaderMap) -> IpAddr {
        let mut client = peer;
        let mut said = said(headers);
        while self.contains(client) {
            match said.pop() {
                Some(Some(before)) => client = before,
                // Nobody, or somebody who hides it.
                Some(None) | None => break,
            }
        }
        client
    }
}

/// Addresses in `X-Forwarded-For`, or else in `Forwarded` (RFC 7239), in the order of the hops. In this order, since
/// most proxies write the first, and pass on what a client writes into the second.
fn said(headers: &HeaderMap) -> Vec<Option<IpAddr>> {
    let words = |name: HeaderName| {
        let texts = headers.get_all(name).iter().map(|value| value.to_str().unwrap_or_default().to_owned());
        texts.flat_map(|text| text.split(',').map(|word| word.trim().to_owned()).collect::<Vec<_>>())
    };
    let hops: Vec<Option<IpAddr>> =
        words(HeaderName::from_static("x-forwarded-for")).map(|word| address(&word)).collect();
    if !hops.is_empty() {
        return hops;
    }
    let address_of = |hop: String| {
        let mut pairs = hop.split(';').filter_map(|pair| pair.trim().split_once('='));
        pairs.find(|(name, _)| name.eq_ignore_ascii_case("for")).and_then(|(_, value)| address(value))
    };
    words(header::FORWARDED).map(address_of).collect()
}

/// An address that may have quotes, brackets and a port.
fn address(text: &str) -> Option<IpAddr> {
    let text = text.trim_matches('"');
    let bare = match text.strip_prefix('[') {
        Some(rest) => rest.split(']').next()?,
        None if text.matches(':').count() == 1 => text.split(':').next()?,
        None => text,
    };
    bare.parse().ok().map(|address: IpAddr| address.to_canonical())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn client(peer: &str, headers: &[(&'static str, &'static str)]) -> String {
        let proxies: Networks = "127.0.0.1, 10.0.0.0/8,fd00::/8".parse().expect("networks");
        let mut map = HeaderMap::new();
        for (name, value) in headers {
            map.append(HeaderName::from_static(name), value.parse().expect("a value"));
        }
        proxies.client(peer.parse().expect("an address"), &map).to_string()
    }

    #[test]
    fn only_trusted_proxies_are_believed() {
        let said = [("x-forwarded-for", "6.6.6.6, 192.0.2.7, 10.1.2.3")];
        assert_eq!(client("127.0.0.1", &said), "192.0.2.7", "the last that no proxy of ours is");
        assert_eq!(client("192.0.2.1", &said), "192.0.2.1", "a stranger says nothing");
        assert_eq!(client("127.0.0.1", &[]), "127.0.0.1");
        let forwarded = [("forwarded", "for=6.6.6.6, for=\"[2001:db8::7]:4711\";proto=https")];
        assert_eq!(client("10.9.9.9", &forwarded), "2001:db8::7");
        assert_eq!(
            client("10.9.9.9", &[forwarded[0], said[0]]),
            "192.0.2.7",
            "what a proxy passed on is nobody's word"
        );
        assert_eq!(client("10.9.9.9", &[("forwarded", "for=_hidden")]), "10.9.9.9");
        assert_eq!(client("10.9.9.9", &[("x-forwarded-for", "192.0.2.7:1234")]), "192.0.2.7");
        assert!("10.0.0.0/33".parse::<Networks>().is_err());
    }
}
