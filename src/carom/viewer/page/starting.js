// Starts the modules of a page that a server has sent. If some of them do not arrive, it says so and loads the
// page again: a browser does not ask twice for a module that has failed. No module itself, so that it can tell.

(() => {
  const ATTEMPTS = "carom attempts";
  const LONGEST_WAIT = 30;
  // A page in that of another site may have no storage.
  const stored = (work) => {
    try {
      return work(sessionStorage);
    } catch {
      return null;
    }
  };
  const modules = document.createElement("script");
  modules.type = "module";
  const own = /** @type {HTMLScriptElement} */ (document.currentScript);
  modules.src = new URL("main.js", own.src).href;
  modules.addEventListener("load", () => stored((storage) => storage.removeItem(ATTEMPTS)));
  modules.addEventListener("error", () => {
    const attempts = Number(stored((storage) => storage.getItem(ATTEMPTS))) + 1;
    stored((storage) => storage.setItem(ATTEMPTS, String(attempts)));
    let wait = Math.min(2 ** attempts, LONGEST_WAIT);
    const notice = document.getElementById("notice");
    notice.hidden = false;
    const tell = () => {
      notice.textContent =
        "Some files of this page have not arrived: the connection was cut off, or the simulation has ended. " +
        `Trying again in ${wait} s.`;
      if (wait-- <= 0) location.reload();
      else setTimeout(tell, 1000);
    };
    tell();
  });
  document.head.append(modules);
})();
