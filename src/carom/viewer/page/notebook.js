// Runs in a notebook, below the cell that shows the page: finds an address at which the browser can reach the
// server on the kernel's machine. The first address that answers is used: the local machine, the proxy of the
// editor that has started the kernel, the proxy of Jupyter, the proxy of Colab.

(async ({ id, port, token, proxy, unreachable }) => {
  const frame = document.getElementById(id);
  if (!(frame instanceof HTMLIFrameElement)) return;
  const query = `?token=${token}`;
  const config = document.getElementById("jupyter-config-data");
  const base = config ? JSON.parse(config.textContent).baseUrl : document.body.dataset.baseUrl;
  const places = [];
  const onThisMachine = /^(localhost|127\.0\.0\.1|\[::1\]|)$/.test(location.hostname);
  if (onThisMachine || location.protocol === "vscode-webview:") places.push(`http://127.0.0.1:${port}/`);
  if (proxy) places.push(proxy);
  if (base) places.push(new URL(`${base.replace(/\/?$/, "/")}proxy/${port}/`, location.href).href);
  const colab = globalThis.google?.colab?.kernel;
  if (colab) places.push((await colab.proxyPort(port, { cache: true })).replace(/\/?$/, "/"));
  const answers = (place) =>
    new Promise((done) => {
      const image = new Image();
      image.onload = () => done(true);
      image.onerror = () => done(false);
      setTimeout(() => done(false), 3000);
      image.src = `${place}icon.svg${query}`;
    });
  for (const place of places) {
    if (!(await answers(place))) continue;
    frame.src = place + query;
    return;
  }
  frame.srcdoc = unreachable;
})(FACTS);
