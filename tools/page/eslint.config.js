// ESLint's rules for the viewer's page. Names that do not exist are left to `tsc`, which knows those of browsers.

import js from "@eslint/js";

export default [
  {
    ...js.configs.recommended,
    files: ["src/carom/viewer/page/**/*.js"],
  },
  {
    files: ["src/carom/viewer/page/**/*.js"],
    linterOptions: { reportUnusedDisableDirectives: "error" },
    rules: {
      "no-undef": "off",
      "no-unused-vars": ["error", { argsIgnorePattern: "^_", ignoreRestSiblings: true }],
      eqeqeq: "error",
      "no-var": "error",
      "prefer-const": ["error", { destructuring: "all" }],
      "no-shadow": "error",
      "no-implicit-coercion": ["error", { boolean: false }],
      "no-unused-expressions": "error",
      "object-shorthand": "error",
      "no-throw-literal": "error",
      "no-self-compare": "error",
      "no-template-curly-in-string": "error",
      "no-use-before-define": ["error", { functions: false, classes: false, variables: false }],
      "default-param-last": "error",
      "array-callback-return": "error",
    },
  },
];
