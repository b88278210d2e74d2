/** Whether this is the page that needs no program (vite.config.ts). */
declare const __PAGE__: boolean;
