// Documents are bundled as their text.

declare module "*.json" {
  const text: string;
  export default text;
}
