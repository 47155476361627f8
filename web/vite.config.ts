import { defineConfig } from "vitest/config";

declare const process: { env: Record<string, string | undefined> };

// The address that `voxlume view` prints, with its token, for the development server.
const viewer = process.env.VOXLUME_VIEW ?? "http://127.0.0.1:8080/";

export default defineConfig({
  base: "./",
  build: { outDir: "../build/web", emptyOutDir: true, target: "es2022" },
  esbuild: { jsx: "automatic", jsxImportSource: "preact" },
  server: {
    host: "127.0.0.1",
    proxy: {
      // The viewer wants Host and Origin to be its own address.
      "/api": {
        target: new URL(viewer).origin,
        ws: true,
        changeOrigin: true,
        configure: (proxy) => {
          const origin = new URL(viewer).origin;
          const rewrite = (request: { setHeader(name: string, value: string): void }) =>
            request.setHeader("origin", origin);
          proxy.on("proxyReq", rewrite);
          proxy.on("proxyReqWs", rewrite);
        },
      },
    },
  },
  test: { include: ["tests/**/*.test.ts"], environment: "node" },
});
