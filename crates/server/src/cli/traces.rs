//! Traces of requests for a collector (OpenTelemetry), where one of OpenTelemetry's own variables names one.
use opentelemetry::trace::TracerProvider;
use opentelemetry_otlp::SpanExporter;
use opentelemetry_sdk::{Resource, trace::SdkTracerProvider};
use tracing_subscriber::{Layer, filter::LevelFilter, registry::LookupSpan};

/// Sends traces; dropped, it sends those that are left.
pub(super) struct Traces(SdkTracerProvider);

impl Drop for Traces {
    fn drop(&mut self) {
        if let Err(error) = self.0.shutdown() {
            tracing::warn!(%error, "the last traces could not be sent");
        }
    }
}

/// Begins to send traces, if a collector is named.
pub(super) fn begin<S>() -> (Option<Traces>, Option<impl Layer<S>>)
where
    S: tracing::Subscriber + for<'span> LookupSpan<'span>,
{
    let is_set = |name| std::env::var(name).is_ok_and(|value| !value.is_empty());
    let is_named = is_set("OTEL_EXPORTER_OTLP_ENDPOINT") || is_set("OTEL_EXPORTER_OTLP_TRACES_ENDPOINT");
    if !is_named || std::env::var("OTEL_SDK_DISABLED").as_deref() == Ok("true") {
        return (None, None);
    }
    // The library for buckets brings TLS along, which the exporter then insists on.
    #[cfg(feature = "s3")]
    drop(rustls::crypto::ring::default_provider().install_default());
    let exporter = match SpanExporter::builder().with_http().build() {
        Ok(exporter) => exporter,
        Err(error) => {
            eprintln!("warning: no traces are sent: {error}");
            return (None, None);
        }
    };
    let mut resource = Resource::builder();
    if !is_set("OTEL_SERVICE_NAME") {
        resource = resource.with_service_name("fosssim-server");
    }
    let provider = SdkTracerProvider::builder().with_batch_exporter(exporter).with_resource(resource.build()).build();
    let layer = tracing_opentelemetry::layer().with_tracer(provider.tracer("fosssim-server"));
    (Some(Traces(provider)), Some(layer.with_filter(LevelFilter::INFO)))
}
