# Image of the program frond, without Python: docker build -t frond -f Dockerfile build/dist, after scripts/package --all.
# It contains the wheel's program and libraries: Debian's package depends on 276 others, movie readers among them, with 790 MB.
FROM debian:13-slim
LABEL org.opencontainers.image.title="frond" \
      org.opencontainers.image.description="Spectral path tracer for plant leaves" \
      org.opencontainers.image.licenses="Apache-2.0 AND BSD-3-Clause AND MIT AND LicenseRef-EC-reuse"
RUN --mount=type=bind,target=/dist \
    apt-get update -qq && \
    apt-get install -y -qq --no-install-recommends libexpat1 unzip && \
    unzip -q /dist/frond_render-*.whl -d /opt/frond && \
    mv /opt/frond/frond_render-*.data/data/share/* /usr/local/share/ && \
    ln -s /opt/frond/frond/bin/frond /usr/local/bin/frond && \
    apt-get purge -y -qq unzip && \
    rm -rf /opt/frond/frond_render-*.data /var/lib/apt/lists/* /var/cache/apt/*.bin
# Cached tables; any user can write there.
ENV XDG_CACHE_HOME=/tmp
WORKDIR /work
ENTRYPOINT ["frond"]
CMD ["--help"]
