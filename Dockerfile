# The tools and the Python module of relief on Debian 12, for pipelines:
#
#   docker build -t relief .
#   docker run --rm -v "$PWD:/work" relief relief-mesh check model.glb
FROM debian:12 AS build
RUN apt-get -q update && apt-get -q -y --no-install-recommends install ca-certificates
COPY . /src
RUN /src/scripts/package /packages

FROM debian:12
COPY --from=build /packages/*.deb /tmp/
RUN apt-get -q update && \
    apt-get -q -y --no-install-recommends install fonts-dejavu-core libosmesa6 \
        /tmp/relief_*.deb /tmp/relief-image-formats_*.deb /tmp/python3-relief_*.deb && \
    rm -rf /var/lib/apt/lists/* /tmp/*.deb
COPY scripts/dev/check-assets /usr/local/bin/
WORKDIR /work
