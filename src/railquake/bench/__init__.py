"""Speed, measured on the machine at hand: `speed` on its processor, `gpu` on its GPU."""
