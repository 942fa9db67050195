// Paths are relative, so that the built page works in any folder of a web server. The program that checks proofs is beside the
// book.
export default {
  base: "./",
  build: { target: "es2022", chunkSizeWarningLimit: 1200 },
  server: { fs: { allow: [".", "../docs/book"] } },
};
