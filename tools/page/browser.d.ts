// What the page's modules find besides what browsers have.

/** The page, for the console and for tests. */
interface Window {
  app: import("../../src/carom/viewer/page/app.js").App;
}

/** What `notebook.py` writes in place of this name: where the server is, and what to show if it is out of reach. */
declare const FACTS: {
  id: string;
  port: number;
  token: string;
  proxy: string | null;
  unreachable: string;
};
