# Images, with Docker's default seccomp profile and without privileges. One grades programs:
#   docker build -t fosssim-oracle .
#   docker run --rm -v "$PWD/submissions:/submissions:ro" -v "$PWD/grades:/grades" \
#       fosssim-oracle grade /submissions --output /grades
# One serves a course, alone, by compose or in Kubernetes (examples/deploy):
#   docker build --target server -t fosssim-server .
#   docker run --rm -p 127.0.0.1:8080:8080 -v fosssim:/data fosssim-server
# Without a registry, name other bases that hold what is installed here (scripts/container-test does): --build-arg
# BUILD_BASE=... --build-arg BASE=...
ARG BUILD_BASE=rust:1-slim-bookworm
ARG BASE=debian:bookworm-slim

FROM ${BUILD_BASE} AS build
RUN command -v c++ >/dev/null || \
    { apt-get update && apt-get install -y --no-install-recommends build-essential && rm -rf /var/lib/apt/lists/*; }
WORKDIR /source
COPY . .
RUN cargo build --release --locked --bin fosssim-oracle

# Outside of /usr, which build steps may read.
FROM ${BASE} AS base
RUN { command -v c++ >/dev/null && [ -e /usr/include/GL/freeglut.h ] && [ -e /usr/include/png.h ]; } || \
    { apt-get update \
    && apt-get install -y --no-install-recommends build-essential ca-certificates freeglut3-dev libpng-dev \
    && rm -rf /var/lib/apt/lists/*; }
COPY --from=build /source/target/release/fosssim-oracle /opt/fosssim/
RUN ln -s /opt/fosssim/fosssim-oracle /usr/local/bin/

FROM build AS build-server
RUN cargo build --release --locked -p fosssim-server

FROM base AS server
COPY --from=build-server /source/target/release/fosssim-server /opt/fosssim/
RUN ln -s /opt/fosssim/fosssim-server /usr/local/bin/ \
    && useradd --system --uid 10001 --home-dir /data fosssim && install -d -o fosssim -m 700 /data
USER fosssim
# A worker's container asks for a sign of life instead: --health-cmd 'fosssim-server health --data /data'.
HEALTHCHECK --interval=15s --timeout=6s --start-period=60s --retries=4 \
    CMD ["fosssim-server", "health", "--server", "http://127.0.0.1:8080"]
CMD ["fosssim-server", "serve", "--data", "/data", "--listen", "0.0.0.0:8080"]

FROM base AS grader
ENTRYPOINT ["fosssim-oracle"]
CMD ["--help"]
