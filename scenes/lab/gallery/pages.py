"""All pages of the gallery, in their order."""

from scenes.lab.gallery import contacts, extremes, masks, motions, piles, sweeps

PAGES = (*sweeps.PAGES, *motions.PAGES, *contacts.PAGES, *piles.PAGES, *masks.PAGES, *extremes.PAGES)
