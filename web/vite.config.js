// Paths are relative, so that the built page works in any folder of a web server.
export default { base: "./", build: { target: "es2022", chunkSizeWarningLimit: 1000 } };
